"""Foundation F2, rotations: Exp and Log, the adjoint, and why a mean of roll, pitch and yaw fails."""
