"""How fast this machine is: standard problems, the roofline above them, a peer beside them."""

BOX, DAM, FALLING = "box", "dam", "falling"

PROBLEMS = {
    BOX: "jittered periodic box at rest",
    DAM: "dam break just started",
    FALLING: "dam break half-way through its fall",
}
"""What can be timed, in words."""
