"""What others wrote is shown by a terminal, never obeyed."""

import io
import unicodedata

from dqpaint.clean_stream import CleanStream, cleaned, printable, send_raw


def test_no_control_character_and_no_turned_line_is_left():
    for code in range(0x110000):
        letter = chr(code)
        shown = printable(letter)
        if letter in "\n\t" or 0xD800 <= code < 0xE000:
            continue
        commands = unicodedata.category(letter) == "Cc"
        turns = unicodedata.bidirectional(letter) in (
            "LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI", "B",
        )  # fmt: skip
        assert (shown != letter) >= (commands or turns), hex(code)
        assert all(ord(one) >= 32 for one in shown)
    assert printable("a\x1b[31m\x9b\u202eé▀\n\tz") == "a\\x1b[31m\\x9b\\u202eé▀\n\tz"


def test_a_stream_keeps_its_encoding_and_what_the_program_sends():
    raw = io.BytesIO()
    under = io.TextIOWrapper(raw, "ascii")
    stream = cleaned(under)
    assert isinstance(stream, CleanStream)
    print("a\x1b]0;b\x07é", file=stream)
    send_raw("\x1b[K", stream)
    assert raw.getvalue() == b"a\\x1b]0;b\\x07\\xe9\n\x1b[K"
    del stream
    print("and on", file=under, flush=True)
    assert raw.getvalue().endswith(b"and on\n")
    plain = io.StringIO()
    assert cleaned(plain) is plain
