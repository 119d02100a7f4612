"""Training of the object detector of the spherical stereo method. Only this part of the course needs PyTorch."""
