"""Beyond paper 1, which is given its start: where is the camera when nobody says, and after it was carried away?"""
