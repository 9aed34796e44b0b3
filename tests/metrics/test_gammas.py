"""(3.26): errors under an uncertain pose c(t) and a twist, beside the four gammas."""

import json

import numpy as np
import pytest

import dqpaint
from dqpaint import dq

GAMMAS = {"gamma_O1": 0.2, "gamma_O2": 0.1, "gamma_T1": 0.3, "gamma_T2": 0.06}
BOTH = {
    "offset": {"form": "sine", "x": 0.004, "wz": 0.02, "frequency": 1.0},
    "twist": {"form": "constant", "y": 0.01, "wx": 0.02},
}


@pytest.fixture
def still(tmp_path):
    path = tmp_path / "still.traj"
    path.write_text("period 4 ms\nstart at (0, 0) mm\nhold 2 s\n")
    return path


def norm(signal):
    return np.sqrt((signal**2).sum())


@pytest.mark.parametrize("point", ["base", "tool"])
@pytest.mark.parametrize("disturb", [BOTH, {"offset": BOTH["offset"]}], ids=["both", "c alone"])
def test_the_error_as_a_part_of_what_the_gammas_allow(still, disturb, point):
    """By homogeneous matrices, from the CSV's poses; and the promise is kept."""
    run = dqpaint.draw(still, plant="ideal", disturb=disturb, gains={**GAMMAS, "point": point},
                       size=(64, 36))  # fmt: skip
    track = run.track
    T, T_d = (dq.matrix_from_pose(x) for x in (track.pose, track.motion.pose))
    R_e = T[:, :3, :3] @ T_d[:, :3, :3].swapaxes(1, 2)
    t, t_d = T[:, :3, 3], T_d[:, :3, 3]
    p_e = t - (t_d if point == "tool" else np.einsum("nij,nj->ni", R_e, t_d))
    cosine = np.clip((np.trace(R_e, axis1=1, axis2=2) - 1) / 2, -1, 1)
    turned = np.sqrt(2 - 2 * np.cos(np.arccos(cosine) / 2))  # |1 - r_e|
    v_w, v_c = track.disturbance[:-1], track.pose_disturbance[:-1]
    if point == "tool":
        v_w, v_c = (np.c_[v[:, :3], v[:, 3:] + np.cross(v[:, :3], t[:-1])] for v in (v_w, v_c))
    allowed = [
        GAMMAS[f"gamma_{part}1"] * norm(v_w[:, half])
        + GAMMAS[f"gamma_{part}2"] * norm(v_c[:, half])
        for part, half in (("O", slice(0, 3)), ("T", slice(3, 6)))
    ]
    for part, error, most in zip(("rotation", "translation"), (turned, p_e), allowed, strict=True):
        found = run.attenuation[part].of_gammas
        assert found == pytest.approx(norm(error[1:]) / most, rel=1e-6)
        assert 0.05 < found < 1
        assert run.attenuation[part].bound_holds


def test_a_gamma_not_asked_allows_everything(still, tmp_path):
    """Nothing is promised of c with gamma_O1 alone; the summary has the share."""
    run = dqpaint.draw(still, plant="ideal", disturb=BOTH, gains={"gamma_O1": 0.1}, size=(64, 36))
    assert run.attenuation["rotation"].of_gammas == 0
    assert 0 < run.attenuation["translation"].of_gammas < 1
    dqpaint.save(run, tmp_path)
    (summary,) = tmp_path.glob("*.json")
    assert json.loads(summary.read_text())["attenuation"]["rotation"]["of_gammas"] == 0


def test_a_law_without_gammas_has_none(still):
    run = dqpaint.draw(still, controller="p", plant="ideal", disturb=BOTH, size=(64, 36))
    assert run.attenuation["rotation"].of_gammas is None
