"""Guarded pictures: planted faults are told by the right gate; numeric noise is not."""

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace

import cv2
import numpy as np
import pytest

from dqpaint.core import library_versions
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.studies.kinds import verify as study
from dqpaint.studies.verify.gates import GATES, failed_gates, largest_change, measure
from dqpaint.studies.verify.references import read_cases, read_reference
from tests.support import guarded

pytestmark = pytest.mark.slow
OTHER_CPU = {"OPENBLAS_CORETYPE": "Prescott", "OPENCV_CPU_DISABLE": "AVX2",
             "NPY_DISABLE_CPU_FEATURES": "AVX2"}  # fmt: skip


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    made = guarded.make(tmp_path_factory.mktemp("original") / "guarded")
    assert study.update(study.verify(made, 1), made) == ["corner: new"]
    return made


@pytest.fixture
def folder(tmp_path, original):
    return shutil.copytree(original, tmp_path / "guarded")


def verdict(folder):
    (one,) = study.verify(folder, 1)
    return one


def test_the_same_is_alike_on_another_processor_too(folder, tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "dqpaint", "verify", str(folder)], cwd=tmp_path,
        capture_output=True, text=True, env={**os.environ, **OTHER_CPU}, timeout=100,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert "alike" in done.stdout
    assert not (tmp_path / "verify-differences").exists()


FAULTS = {
    "half a millimetre": (lambda f: guarded.shifted(f, 0.5e-3), ["film L1", "u8 max", "metrics"]),
    "a tenth": (lambda f: guarded.shifted(f, 0.1e-3), ["film max", "film L1", "metrics"]),
    "a gap of 10 samples": (guarded.with_gap, ["film max", "energy", "1 - min SSIM", "u8 max"]),
    "2 % of gain": (lambda f: guarded.with_gain(f, 1.02), ["metrics"]),
    "0.1 % of gain": (lambda f: guarded.with_gain(f, 1.001), ["metrics"]),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_planted_faults_are_told_by_their_gates(folder, tmp_path, fault):
    plant, gates = FAULTS[fault]
    plant(folder)
    one = verdict(folder)
    said = ", ".join(one.faults)
    for gate in gates:
        assert gate in said
    if fault == "0.1 % of gain":
        assert len(one.faults) == 1  # what the film cannot see the figures do
    (path,) = study.save_differences([one], tmp_path / "out")
    picture = cv2.imread(str(path))
    third = picture[40:, 2 * picture.shape[1] // 3 :]
    assert third.max() == 255  # where it differs
    assert said in study.table_text([one])
    if fault == "a gap of 10 samples":
        gap = third.max(axis=2) > 120
        assert 0 < gap.mean() < 0.01  # nowhere else


@pytest.mark.parametrize("fault", ["half a millimetre", "a gap of 10 samples", "2 % of gain"])
def test_the_wider_gates_see_them_too(folder, fault):
    FAULTS[fault][0](folder)
    one = verdict(folder)
    assert failed_gates(one.measured, alike=False)


def test_numeric_noise_passes_and_ten_times_the_gates_does_not(folder):
    one = verdict(folder)
    rng = np.random.default_rng(3)

    def with_noise(size):
        noise = 1 + size * rng.uniform(-1, 1, one.made["planes"].shape).astype(np.float64)
        made = {**one.made, "planes": one.made["planes"] * noise}
        figures = {name: v * (1 + size) for name, v in one.result.figures.items()}
        return failed_gates(
            measure(one.reference, replace(one.result, figures=figures), made), True
        )

    assert with_noise(1e-7) == []
    assert {name.split(" (")[0] for name in with_noise(1e-4)} == {"film max", "film L1", "metrics"}


def test_light_that_is_neither_on_the_film_nor_lost_is_told(folder):
    one = verdict(folder)
    made = {**one.made, "balance": np.array(1e-6)}
    assert failed_gates(measure(one.reference, one.result, made), True) == ["balance"]


def test_a_gate_that_is_none_is_a_dash():
    limits = study.table([])[-1]
    assert limits[0] == "other versions"
    assert limits[1] == "-"
    assert "inf" not in limits


def test_figures_are_compared_by_their_size():
    assert largest_change({"a": 2.0, "b": 1e-14}, {"a": 2.02, "b": 3e-14})[1] == "a"
    assert largest_change({"a": 2.0}, {"a": 2.02})[0] == pytest.approx(0.01, rel=1e-6)
    assert largest_change({"a": -2.0}, {"a": -2.02})[0] == pytest.approx(
        0.01, rel=1e-6
    )  # downwards, too
    assert largest_change({"a": 2.0}, {}) == (np.inf, "a")
    assert largest_change({"a": 2.0}, {"a": 2.0, "new": 1.0}) == (0.0, "")
    assert len({gate.name for gate in GATES}) == len(GATES)


def test_update_says_what_changed_and_leaves_the_rest(folder):
    before = (folder / "corner.tiff").read_bytes()
    assert study.update(study.verify(folder, 1), folder) == ["corner: unchanged"]
    guarded.with_gain(folder, 1.02)
    (line,) = study.update(study.verify(folder, 1), folder)
    assert "metrics" in line
    assert " was " in line
    assert " is " in line
    assert (folder / "corner.tiff").read_bytes() != before
    assert not verdict(folder).faults


def test_remarks_tell_of_other_versions_and_texts(folder):
    facts = json.loads((folder / "corner.json").read_text())
    facts["versions"]["numpy"] = "1.0"
    (folder / "corner.json").write_text(json.dumps(facts))
    (folder / "corner.traj").write_text("# a word\n" + guarded.DRAWING)
    one = verdict(folder)
    assert not one.faults
    assert any("wider gates" in text for text in one.remarks)
    assert any("text has changed" in text for text in one.remarks)
    assert library_versions().keys() == facts["versions"].keys()


def test_a_run_that_fails_is_a_fault_and_no_reference(folder):
    (folder / "mylaw.py").write_text("def mylaw(seen, k=1.0):\n    return [0]\n")
    one = verdict(folder)
    assert one.faults[0].startswith("run failed: mylaw.py:1")
    assert "differs: run failed" in study.table_text([one])
    before = (folder / "corner.json").read_bytes()
    with pytest.raises(DqpaintError, match="no reference"):
        study.update([one], folder)
    assert (folder / "corner.json").read_bytes() == before


def test_damaged_references_and_folders_are_told(folder, tmp_path):
    (case,) = read_cases(folder)
    for end, data in ((".png", b"no"), (".tiff", b""), (".json", b"{}"), (".json", b"\xff")):
        whole = (folder / f"corner{end}").read_bytes()
        (folder / f"corner{end}").write_bytes(data)
        with pytest.raises(DqpaintError, match="--update"):
            read_reference(folder, case)
        (folder / f"corner{end}").write_bytes(whole)
    (folder / "corner.png").unlink()
    with pytest.raises(DqpaintError, match=r"lacks corner\.png"):
        study.verify(folder, 1)
    assert "corner: new" in study.update(study.verify(folder, 1, lenient=True), folder)
    with pytest.raises(DqpaintError, match="no folder"):
        study.verify(tmp_path / "none")
    (tmp_path / "empty").mkdir()
    with pytest.raises(DqpaintError, match="neither drawings"):
        study.verify(tmp_path / "empty")


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("[a]\n", "drawing"), ("a = 3\n", "drawing"),
        ('["../a"]\ndrawing = "star"\n', "a case's name"),
        ('[a]\ndrawing = "star"\nspeed = 3\n', r"\[a\]: .*'speed'"),
        ('[a]\ndrawing = "none"\n', "'none'"), ("[a\n", "cases.toml"),
    ],
)  # fmt: skip
def test_bad_cases_are_told(tmp_path, text, fault):
    (tmp_path / "cases.toml").write_text(text)
    with pytest.raises((UsageError, DqpaintError), match=fault):
        read_cases(tmp_path)


def test_a_folder_of_drawings_alone_needs_no_table(tmp_path):
    for name in ("b", "a"):
        (tmp_path / f"{name}.traj").write_text(guarded.DRAWING)
    assert [case.name for case in read_cases(tmp_path)] == ["a", "b"]


@pytest.mark.parametrize("name", ["controller", "plant", "brush"])
def test_code_outside_the_folder_is_run_if_it_is_trusted_alone(tmp_path, name):
    folder = tmp_path / "cases"
    folder.mkdir()
    (tmp_path / "own.py").write_text("raise ValueError('it ran')\n")
    (folder / "a.traj").write_text(guarded.DRAWING)
    (folder / "cases.toml").write_text(f'[a]\ndrawing = "a.traj"\n{name} = "../own.py:own"\n')
    with pytest.raises(UsageError, match=rf"\[a\]: {name} '.*own\.py' is code outside .* --trust"):
        study.verify(folder, 1)
    with pytest.raises(DqpaintError, match="it ran"):
        study.verify(folder, 1, trust=True)
