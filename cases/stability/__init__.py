"""Where methods fail: sweeps of one parameter into failure."""
