"""Arms whose numbers are published, as cards: built from rows or axes, with guessed bodies."""

import numpy as np

from dqpaint.robots.model.card import Card, read_card
from dqpaint.robots.model.chain import Axes, Body, Row, Rows
from dqpaint.robots.model.fields import Mount

IIWA = Rows(
    rows=tuple(
        Row(d_m=d, alpha_deg=alpha)
        for d, alpha in zip(
            (0.36, 0, 0.42, 0, 0.4, 0, 0.081), (-90, 90, 90, -90, -90, 90, 0), strict=True
        )
    )
)
PANDA = Rows(  # Franka's own table
    convention="modified",
    rows=tuple(
        Row(d_m=d, a_m=a, alpha_deg=alpha)
        for d, a, alpha in zip(
            (0.333, 0, 0.316, 0, 0.384, 0, 0),
            (0, 0, 0, 0.0825, -0.0825, 0, 0.088),
            (0, -90, 90, 90, -90, 90, 90),
            strict=True,
        )
    ),
    flange=Mount(at_m=(0, 0, 0.107)),
)
S = np.sqrt(0.5)
BAXTER = Axes(  # the right arm: the configuration beside Chandra 2020's code
    points_m=(
        (0.064027, -0.259027, 0.129626), (0.112818, -0.307818, 0.399976),
        (0.184942, -0.379943, 0.399976), (0.370501, -0.565502, 0.330976),
        (0.44375, -0.638751, 0.330976), (0.635163, -0.830166, 0.320976),
        (0.71717, -0.912173, 0.320976),
    ),
    directions=((0, 0, 1), *((S, S, 0), (S, -S, 0)) * 3),
    flange=Mount(at_m=(0.797462, -0.992465, 0.320976), rpy_deg=(10, 90, -45)),
)  # fmt: skip


def built(name, chain):
    """A card of one of these chains, with limits of +-170 degrees."""
    n = len(chain.rows) if isinstance(chain, Rows) else len(chain.points_m)
    table = "denavit_hartenberg" if isinstance(chain, Rows) else "screws"
    return Card(
        name=name, title=name, source="a test", licence="none", home_deg=(10.0,) * n,
        tool=Mount(at_m=(0.01, 0.02, 0.08), rpy_deg=(10, 20, 30)),
        canvas=read_card("iiwa").canvas,
        limits={
            "lower_deg": [-170] * n, "upper_deg": [170] * n,
            "speed_deg_s": [100] * n, "effort_Nm": [50] * n,
        },
        body=Body(mass_kg=tuple(np.linspace(3, 0.5, n)), radius_m=(0.06,) * (n + 1)),
        **{table: chain},
    )  # fmt: skip


CARDS = {
    **{name: read_card(name) for name in ("viper850", "lwr4", "meka-a2")},
    "iiwa": built("iiwa", IIWA),
    "panda": built("panda", PANDA),
    "baxter": built("baxter", BAXTER),
}
