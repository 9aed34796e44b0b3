"""The light at the tool becomes a long-exposure picture.

In comes where the lamp was at N instants, with its colour between them; out goes an (H, W, 3) array
of 8-bit sRGB. Between the two there is one noun a step, each linear in the light until the last:

    positions, colours -shine-> Light -expose-> Film -spread-> image -develop-> picture
                          points -frame-> Camera ~^                  ^~ automatic_exposure

Nothing here knows of robots: the light may come from what was asked or from what an arm achieved.
"""
