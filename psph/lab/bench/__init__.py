"""Speed on this machine: standard problems, their roofline, and LAMMPS for comparison."""

BOX, DAM, FALLING = "box", "dam", "falling"

PROBLEMS = {
    BOX: "jittered periodic box at rest",
    DAM: "dam break just started",
    FALLING: "dam break half-way through its fall",
}
"""The problems that can be timed, in words."""
