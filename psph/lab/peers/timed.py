"""One run, timed from its first step: ``python -P psph/lab/peers/timed.py CASE FOLDER KEY=VALUE...``.

The file needs nothing of this folder, so that older sources of psph on the path can run it.
"""

import json
import sys
import time
from pathlib import Path

from psph.case import load
from psph.parallel.reductions import world
from psph.runs import start


def main(arguments: list[str]) -> int:
    """Run a case, and print the CPU seconds from its first step on; the exit code."""
    case, folder, *keys = arguments
    begun: list[float] = []

    def after(simulation) -> bool:
        if not begun:
            begun.append(time.process_time())
        return False

    start.run(load(Path(case), keys), Path(folder), world(), overwrite=True, after_step=after)
    print(json.dumps({"run": time.process_time() - begun[0]}))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
