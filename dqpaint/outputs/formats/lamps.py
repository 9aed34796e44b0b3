"""The baked light -> programs of the lamp's own controller: CircuitPython, Arduino with FastLED."""

from typing import TYPE_CHECKING

from dqpaint.outputs.registry import writer

if TYPE_CHECKING:
    from dqpaint.painting import paint

IN_A_LINE = 16

PYTHON = """\
import time

import board
import digitalio
import neopixel

LEDS = {leds}
TICK_NS = {tick}000
TABLE = (
{table}
)
ENTRY = 2 + 3 * LEDS

pixels = neopixel.NeoPixel(board.D5, LEDS, brightness=1.0, auto_write=False)
wire = digitalio.DigitalInOut(board.D6)
wire.switch_to_input(pull=digitalio.Pull.DOWN)


def play():
    due = time.monotonic_ns()
    for at in range(0, len(TABLE), ENTRY):
        for led in range(LEDS):
            first = at + 2 + 3 * led
            pixels[led] = (TABLE[first], TABLE[first + 1], TABLE[first + 2])
        pixels.show()
        due += (TABLE[at] + 256 * TABLE[at + 1]) * TICK_NS
        while time.monotonic_ns() < due:
            pass
    pixels.fill((0, 0, 0))
    pixels.show()


pixels.fill((0, 0, 0))
pixels.show()
while True:
    while not wire.value:
        pass
    play()
    while wire.value:
        pass
"""

SKETCH = """\
#include <FastLED.h>

const int LEDS = {leds}, DATA_PIN = 5, WIRE_PIN = 2;
const uint32_t TICK_US = {tick}, ENTRY = 2 + 3 * LEDS, BYTES = {size};
const uint8_t TABLE[] PROGMEM = {{
{table}
}};
CRGB leds[LEDS];
volatile bool begun = false;

void begin() {{ begun = true; }}

void setup() {{
  FastLED.addLeds<WS2812B, DATA_PIN, GRB>(leds, LEDS);
  FastLED.setBrightness(255);
  FastLED.setDither(0);
  FastLED.clear(true);
  pinMode(WIRE_PIN, INPUT);
  attachInterrupt(digitalPinToInterrupt(WIRE_PIN), begin, RISING);
}}

void loop() {{
  if (!begun) return;
  uint32_t due = micros();
  for (uint32_t at = 0; at < BYTES; at += ENTRY) {{
    for (int led = 0; led < LEDS; led++) {{
      const uint8_t *first = TABLE + at + 2 + 3 * led;
      leds[led] = CRGB(pgm_read_byte(first), pgm_read_byte(first + 1), pgm_read_byte(first + 2));
    }}
    FastLED.show();
    due += (pgm_read_byte(TABLE + at) + 256UL * pgm_read_byte(TABLE + at + 1)) * TICK_US;
    while ((int32_t)(micros() - due) < 0) {{}}
  }}
  FastLED.clear(true);
  begun = false;
}}
"""


@writer("circuitpython", "-lamp.py")
def circuitpython(painting: "paint.Painting") -> bytes:
    """The light for a lamp that runs CircuitPython: save it as code.py."""
    from dqpaint.outputs.robot import comment_lines, lamp_table

    table = lamp_table(painting)
    notes = ("CircuitPython: LEDs on D5, the wire on D6, high to begin; save it as code.py.",)
    rows = ['    b"' + "".join(f"\\x{byte:02x}" for byte in row) + '"' for row in _rows(table.data)]
    body = PYTHON.format(leds=table.leds, tick=table.tick, table="\n".join(rows))
    return (comment_lines((*table.about, *notes)) + body).encode()


@writer("fastled", "-lamp.ino")
def fastled(painting: "paint.Painting") -> bytes:
    """The light for a lamp that runs an Arduino sketch with FastLED."""
    from dqpaint.outputs.robot import comment_lines, lamp_table

    table = lamp_table(painting)
    notes = ("Arduino: FastLED, LEDs on pin 5, the wire on pin 2, rising to begin.",)
    rows = ["  " + ", ".join(map(str, row)) + "," for row in _rows(table.data)]
    body = SKETCH.format(
        leds=table.leds, tick=table.tick, size=len(table.data), table="\n".join(rows)
    )
    return (comment_lines((*table.about, *notes), "//") + body).encode()


def _rows(data: bytes) -> list[bytes]:
    return [data[at : at + IN_A_LINE] for at in range(0, len(data), IN_A_LINE)]
