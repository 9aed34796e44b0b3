"""A drawing -> the studio: a live page in the browser, served on this machine alone.

    page        text, picture, arm, curves, figures and time of one open page
    workers     two processes: one reads and sketches, one runs arms; the newest request wins
    jobs        what they do; `limits` keeps them within the folder
    guard       token, Host and Origin of every request, websockets included

Nothing here is imported by the rest of the package but by the command that starts it.
"""

from dqpaint.studio.start import DEFAULT_PORT, serve

__all__ = ["DEFAULT_PORT", "serve"]
