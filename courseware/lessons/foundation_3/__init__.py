"""Foundation F3, Kalman and fusion: the filter in matrices, estimates that share a past, and a test of honesty."""
