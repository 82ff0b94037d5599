"""Loops whose arguments keep their types: numba reads these once and not at every call.

To find the code for its arguments numba reads the type of each, in Python where a named tuple stands
among them: some ten microseconds a call, as long as the loop itself takes over a hundred particles.
"""

import numba


class Settled:
    """A compiled loop that is called with arguments of the same types each time.

    The first call finds the code, and compiles it where there is none.  Who calls it answers for the
    types: an engine has loops of its own, and the types of its arrays follow from its plan.
    """

    def __init__(self, loop):
        self.loop, self.__name__ = loop, loop.__name__
        self._code = None

    def __call__(self, *args):
        if self._code is None:
            self.prepare(*args)
        return self._code(*args)

    def prepare(self, *args) -> None:
        """Find the code for arguments of these types, without a call."""
        self._code = self.loop.compile(tuple(map(numba.typeof, args)))


def settled(loop):
    """``loop`` as a :class:`Settled` one; itself where it is plain Python."""
    return Settled(loop) if hasattr(loop, "compile") else loop
