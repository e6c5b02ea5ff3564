"""Models of other programs, built or run from exported superelements."""
