"""What a rule between the keys of a case finds."""

from typing import Any

Location = tuple[str | int, ...]
Finding = tuple[Location, Any, str]
"""Location, value, and a message that says what is wrong and what to do."""
