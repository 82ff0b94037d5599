"""What happens between particles: effects as typed values, free of MPI, files and case keys."""
