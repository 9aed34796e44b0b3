"""The arm itself before the camera: what it looks like, what lights it, and what it hides.

In come plain arrays: postures of the arm, where lamps were and what they emitted. Out go linear
light to add to a picture before it is developed, and shares of light that the arm's own body let
through to the camera. Nothing here is loaded unless one of the two is asked for.

    Arm -measure-> Surfaces -photograph-> linear light of arm and floor, lit by Lamps
    Arm -> Twins -visible-> the share of each lamp's light that reaches the camera

`staging` is the door: one arm with the postures of one run.
"""
