"""A drawing -> the studio: a live page in the browser, served on this machine alone.

    guard       token, Host and Origin of every request, websockets included
    folder      the drawings that may be opened and saved; sharing: links and files
    page        what is seen of one open page
    work        two processes: one reads and sketches, one runs arms; the newest request wins

Nothing here is imported by the rest of the package but by the command that starts it.
"""

from dqpaint.studio.start import DEFAULT_PORT, serve

__all__ = ["DEFAULT_PORT", "serve"]
