"""Files of guests are used by cases, not collected as tests."""

collect_ignore = ["elastic.py", "curvature.py", "swinging.py", "passing.py", "dust.py", "markers.py"]
