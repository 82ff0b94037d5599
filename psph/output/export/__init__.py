"""The frames of a run in the files of other programs: VTK, Gadget-like HDF5, a script for ParaView."""
