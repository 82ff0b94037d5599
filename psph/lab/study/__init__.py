"""What accuracy costs in time: a case over a ladder of choices, judged, fitted and said."""
