"""Speed on this machine: standard problems, their roofline, and LAMMPS for comparison."""

BOX, DAM, FALLING, BLOCK, GAS = "box", "dam", "falling", "block", "gas"

PROBLEMS = {
    BOX: "jittered periodic box at rest",
    DAM: "dam break just started",
    FALLING: "dam break half-way through its fall",
    BLOCK: "elastic block that spins, total Lagrangian",
    GAS: "blast in an ideal gas, sizes by iteration",
}
"""The problems that can be timed, in words."""
