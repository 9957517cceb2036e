"""Shape of the cam: lift, pitch curve, contour. Knows no other package of the project."""
