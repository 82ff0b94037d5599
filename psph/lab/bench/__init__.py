"""Speed on this machine: standard problems, their roofline, and LAMMPS for comparison."""

BOX, DAM, FALLING, BLOCK = "box", "dam", "falling", "block"

PROBLEMS = {
    BOX: "jittered periodic box at rest",
    DAM: "dam break just started",
    FALLING: "dam break half-way through its fall",
    BLOCK: "elastic block that spins, total Lagrangian",
}
"""The problems that can be timed, in words."""
