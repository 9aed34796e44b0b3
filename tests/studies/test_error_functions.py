"""The page "which error?": its figures are those of the laws."""

from pathlib import Path

import numpy as np

from dqpaint.core import tables
from dqpaint.studies.kinds import error_functions

PAGE = Path(__file__).parents[2] / "docs/which-error.md"


def test_the_page_has_the_laws_own_figures():
    assert tables.markdown(error_functions.table()) in PAGE.read_text("utf-8")


def test_the_functions_are_what_the_chart_says():
    angles = np.linspace(0.0, 3.1, 40)
    forms = {
        "log": angles, "sine": 2 * np.sin(angles / 2), "hinf": np.sin(angles / 2),
        "se3": np.sin(angles),
    }  # fmt: skip
    assert forms.keys() == error_functions.LAWS.keys()
    for law, (gains, _) in error_functions.LAWS.items():
        found = error_functions.turning_rates(law, gains, angles)
        np.testing.assert_allclose(found, forms[law], atol=1e-12)


def test_the_times_that_the_page_states():
    """From 179 to 90 degrees: tan(theta / 2) at K for `se3`, theta at K for `log`."""
    se3 = np.log(np.tan(np.radians(89.5)) / np.tan(np.radians(45)))
    assert round(se3, 1) == 4.7
    assert round(np.log(179 / 90), 1) == 0.7
