"""A published procedure for validating drivetrain, pitch and yaw models, put to the test."""
