"""Bytes of a file -> the same with something changed at random."""

import random
import re

TOKEN = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[A-Za-z_]+|.", re.DOTALL)
NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
SCRAPS = (b"0", b"-1", b"nan", b"inf", b"1e400", b"1e-9", b"5e-324", b"1e9", b"", b"\0", b"\n",
          b"\xff", b"\xf0\x9f\x98\x80", b"\x1b[31m", b" ", b"9" * 30, b"((", b'"')  # fmt: skip


def changed(
    data: bytes, others: list[bytes], words: tuple[bytes, ...], chance: random.Random
) -> bytes:
    """A file with one to six things in it changed: words, numbers, bytes, pieces."""
    for _ in range(chance.choice((1, 1, 1, 2, 2, 3, 6))):
        size = len(data)
        at = chance.randrange(size + 1)
        end = min(size, at + chance.choice((1, 1, 2, 4, 8, 40, 200)))
        way = chance.randrange(9)
        if way == 0:  # a word, or a scrap, or a word of the file, for a word
            words_of = list(TOKEN.finditer(data, max(0, at - 30), min(size, at + 300)))
            if words_of:
                old = chance.choice(words_of)
                new = chance.choice((chance.choice(words or SCRAPS), chance.choice(SCRAPS),
                                     chance.choice(words_of)[0]))  # fmt: skip
                data = data[: old.start()] + new + data[old.end() :]
        elif way == 1:  # a number for a number
            numbers = list(NUMBER.finditer(data, max(0, at - 100), min(size, at + 300)))
            if numbers:
                old = chance.choice(numbers)
                new = chance.choice((*SCRAPS[:8], b"%d" % chance.randrange(-9, 300),
                                     b"%g" % (10 ** chance.uniform(-12, 12))))  # fmt: skip
                data = data[: old.start()] + new + data[old.end() :]
        elif way == 2:
            data = data[:at] + data[end:]
        elif way == 3:
            data = data[:at] + data[at:end] * chance.choice((2, 3, 50)) + data[end:]
        elif way == 4 and size:
            at = min(at, size - 1)
            data = data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1 :]
        elif way == 5:
            data = data[:at] + chance.choice((*words, *SCRAPS)) + data[at:]
        elif way == 6:
            other = chance.choice(others)
            begin = chance.randrange(len(other) + 1)
            data = data[:at] + other[begin : begin + chance.choice((4, 30, 300))] + data[end:]
        elif way == 7:
            number = chance.choice((0, 1, 0x7F, 0xFF, 0x7FFFFFFF, 0xFFFFFFFF, 2**63 - 1))
            raw = number.to_bytes(8, chance.choice(("little", "big")))
            data = data[:at] + raw[: chance.choice((1, 2, 4, 8))] + data[end:]
        elif chance.random() < 0.1:
            data = data[:at]
    return data[:200_000]
