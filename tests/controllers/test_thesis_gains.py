"""Gains over a drawing, and that those of the thesis can be written."""

import numpy as np
import pytest

from dqpaint.controllers import CONTROLLERS
from dqpaint.errors import UsageError

PARTS = np.linspace(0, 1, 1001)  # t / t_f


def gain(law, parts=PARTS, *, read, **given):
    """What the law sees of a gain at every part of the drawing."""
    return np.array([getattr(now, read) for now in CONTROLLERS[law].read_gains(given).over(parts)])


def test_equation_5_9():
    """k_O from 2.8 to 5.3 and k_T from 2.4 to 3.8 over the first tenth."""
    early = np.minimum(PARTS / 0.1, 1.0)
    given = {"K_O": "2.8..5.3@10%", "K_T": "2.4..3.8@10%"}
    for law in ("hinf", "hinf-set"):
        np.testing.assert_allclose(gain(law, read="k_O", **given), 2.8 + 2.5 * early, atol=1e-12)
        np.testing.assert_allclose(gain(law, read="k_T", **given), 2.4 + 1.4 * early, atol=1e-12)
    last = CONTROLLERS["hinf"].read_gains(given).at(1.0).as_dict()
    assert last["gamma_O"] == pytest.approx(0.372, abs=0.006)  # the thesis rounds 0.3774
    assert last["gamma_T"] == pytest.approx(0.372, abs=0.001)


def test_table_5_11():
    """LQR in R8: q jumps from 220 to 270 at 0.3 t_f, r stays 0.01."""
    found = gain("lqr8", read="q", q="220..220@30%..270@30%", r=0.01)
    np.testing.assert_allclose(found, np.where(PARTS < 0.3, 220.0, 270.0), rtol=1e-14)


LN2 = np.log(2)
SLOW = np.minimum(PARTS / 0.3, 1.0)


@pytest.mark.parametrize(("given", "read", "wanted"), [
    # k: (k_O(t_f) - 2.3) + t / t_f (k_O(t_f) - 2.8) with k_O(t_f) = 5.3. A slip of the table: it
    # begins at 3 and ends at 5.5, not at k_O(t_f); 2.3 and 2.5 would fit, or 2.8 twice
    ("3..5.5", "k_O", (5.3 - 2.3) + PARTS * (5.3 - 2.8)),
    ("2.4..3.8@30%", "k_T", (3.8 - 1.4) + SLOW * 1.4),
    # k ln 2
    ("1.836835..3.67367", "k_O", 3.67367 / 2 + PARTS * 3.67367 / 2),
    ("1.8..2.634@30%", "k_T", (2.634 - 0.834) + SLOW * 0.834),
    # k (ln 2)^2: k_T begins 1 below its end but rises by 0.826. A slip again: a jump of 0.174
    ("0.826..1.652@30%..1.826@30%", "k_T",
     np.where(PARTS < 0.3, (1.826 - 1) + SLOW * 0.826, 1.826)),
])  # fmt: skip
def test_table_5_12(given, read, wanted):
    found = gain("hinf", read=read, **{read.replace("k", "K"): given})
    np.testing.assert_allclose(found, wanted, atol=1e-12)


def test_a_gain_and_its_gamma_are_refused_together():
    for law in ("hinf", "hinf-set"):
        for both in ({"gamma_O": 0.1, "K_O": "2.8..5.3@10%"}, {"gamma_O": "1..2", "K_O": 3.0}):
            with pytest.raises(UsageError, match=f"'{law}': .*gamma_O or K_O"):
                CONTROLLERS[law].read_gains(both)
        with pytest.raises(UsageError, match="gamma_T or K_T"):
            CONTROLLERS[law].read_gains({"gamma_T": 0.1, "K_T": 3.0, "K_O": 3.0})
        CONTROLLERS[law].read_gains({"gamma_T": 0.1, "K_O": 3.0})


@pytest.mark.parametrize("law", CONTROLLERS)
def test_any_gain_of_any_law_can_change_but_a_weight_of_the_end(law):
    chosen = CONTROLLERS[law]
    for name in set(chosen.gains.model_fields) - set(chosen.gains.constant):
        schedule = chosen.read_gains({name: "0.5..0.75@50%..1"})
        wanted = np.where(PARTS <= 0.5, 0.5 + 0.5 * PARTS, 0.75 + 0.5 * (PARTS - 0.5))
        np.testing.assert_allclose(schedule.column(name, PARTS), wanted, atol=1e-12)
        np.testing.assert_allclose(
            [getattr(now, name) for now in schedule.over(PARTS)], wanted, atol=1e-12
        )
        assert schedule.as_dict()[name] == "0.5..0.75@50%..1"


def test_a_gain_that_stays_is_a_column_of_itself():
    schedule = CONTROLLERS["lqr"].read_gains({"q": "1,2,3,4,5,6"})
    np.testing.assert_array_equal(schedule.column("q", PARTS[:4]), [[1, 2, 3, 4, 5, 6]] * 4)
    np.testing.assert_array_equal(schedule.column("r", PARTS[:4]), [0.01] * 4)


def test_diagonals_change_too_and_what_follows_is_shown():
    schedule = CONTROLLERS["lqr"].read_gains({"q": "4..1,1,1,4,4,4@50%", "r": 0.01})
    np.testing.assert_allclose(schedule.column("q", np.array([0.25])), [[2.5] * 3 + [4] * 3])
    shown = schedule.as_dict()
    assert shown["q"] == "4..1,1,1,4,4,4@50%"
    assert shown["s"] == "0.2,0.2,0.2,0.2,0.2,0.2..0.1,0.1,0.1,0.2,0.2,0.2@50%"
    assert shown["r"] == 0.01


@pytest.mark.parametrize(
    "text", ["1..2@110%", "1..2@50", "..", "1..", "1,2..3,4,5", "1..2..3", "@5%"]
)
def test_what_is_no_schedule_is_refused(text):
    with pytest.raises(UsageError, match="without a unit"):
        CONTROLLERS["lqr"].read_gains({"q": text})
