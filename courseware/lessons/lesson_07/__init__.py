"""Lesson 07, estimate and resample: means on the circle, four resamplers, the Kalman filter, and the filter stepper."""
