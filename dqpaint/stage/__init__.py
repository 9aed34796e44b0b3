"""The arm itself before the camera: what it looks like, what lights it, and what it hides.

In come plain arrays: postures of the arm, where lamps were and what they emitted. Out go linear
light to add to a picture before it is developed, and shares of light that the arm's own body let
through to the camera. Nothing here is loaded unless one of the two is asked for.

    Arm -photograph-> Surfaces ~lamps~> light on the arm
                                  ~lamps~> light on the floor   --> Ghost (H, W, 3)
    Arm -Twins-> rays --> share of light that reaches the camera
"""
