"""Commands in processes of their own, to be killed."""

import os
import signal
import subprocess
import sys
import time


def start(folder, *words):
    return subprocess.Popen(
        [sys.executable, "-m", "dqpaint", *words], cwd=folder, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a parent may ignore it
    )  # fmt: skip


def wait_for_lines(path, count):
    until = time.monotonic() + 60
    while time.monotonic() < until:
        if path.is_file() and path.read_bytes().count(b"\n") >= count:
            return
        time.sleep(0.01)
    raise AssertionError("nothing was done in a minute")


def alive(group):
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


def wait_for_the_end(group):
    until = time.monotonic() + 20
    while alive(group) and time.monotonic() < until:
        time.sleep(0.05)
    assert not alive(group)
