import numpy as np
import pytest

from dqpaint.light.film.projection import BATCH, Projection, cut_into_bins


def trail_of(pixels, energy, breaks=()):
    """Steps from pixel to pixel (N, 2); before each break the lamp jumps, dark."""
    pixels = np.asarray(pixels, float).T
    steps = np.setdiff1d(np.arange(pixels.shape[1] - 1), breaks)
    return Projection(
        pixels[:, :-1][:, steps], pixels[:, 1:][:, steps], np.asarray(energy).T[:, steps],
        np.zeros(3),
    )  # fmt: skip


def by_hand(trail, step):
    """Energy and its centre in each piece, one step after the other."""
    out, runs = [], [[0]]
    count = trail.start.shape[1]
    for k in range(1, count):
        if (trail.start[:, k] == trail.end[:, k - 1]).all():
            runs[-1].append(k)
        else:
            runs.append([k])
    for run in runs:
        length = [float(np.hypot(*(trail.end[:, k] - trail.start[:, k]))) for k in run]
        pieces = max(1, int(np.ceil(sum(length) / step)))
        energy, moment = np.zeros((pieces, 3)), np.zeros((pieces, 2))
        walked = 0.0
        for k, long in zip(run, length, strict=True):
            way = trail.end[:, k] - trail.start[:, k]
            for n in range(pieces):
                low, high = (sum(length) * i / pieces for i in (n, n + 1))
                if long == 0.0:
                    a = b = 0.0
                    at = int(np.ceil(walked / sum(length) * pieces)) - 1 if sum(length) else 0
                    share = float(n == np.clip(at, 0, pieces - 1))
                else:
                    a, b = np.clip([(low - walked) / long, (high - walked) / long], 0.0, 1.0)
                    share = b - a
                middle = trail.start[:, k] + 0.5 * (a + b) * way
                energy[n] += share * trail.energy[:, k]
                moment[n] += share * trail.energy[:, k].sum() * middle
            walked += long
        out += [(e, m / e.sum()) for e, m in zip(energy, moment, strict=True) if e.sum() > 0]
    return out


@pytest.mark.parametrize("scale", [0.01, 0.3, 1.0, 3.0])
@pytest.mark.parametrize("seed", range(3))
def test_pieces_hold_what_was_left_between_their_ends(scale, seed):
    """Short steps and long ones, runs of one step, a lamp that stands still."""
    rng = np.random.default_rng(seed)
    walk = rng.normal(size=(50, 2)) * scale * rng.choice([0.1, 1.0, 5.0], (50, 1))
    walk[rng.integers(0, 50, 9)] = 0.0
    energy = rng.uniform(0, 1, (50, 3))
    energy[rng.integers(0, 50, 12)] = 0.0
    trail = trail_of(50 + np.vstack([[0, 0], np.cumsum(walk, axis=0)]), energy, [7, 8, 30, 41])
    found = list(cut_into_bins(trail, 1.0))
    position = np.concatenate([one.position for one in found], axis=1).T
    energy = np.concatenate([one.energy for one in found], axis=1).T
    wanted = by_hand(trail, 1.0)
    assert len(energy) == len(wanted)
    for e, p, (e_wanted, p_wanted) in zip(energy, position, wanted, strict=True):
        np.testing.assert_allclose(e, e_wanted, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(p, p_wanted, rtol=1e-9)


def test_a_piece_with_next_to_nothing_lies_where_it_is():
    """What cancels must not throw its centre off the film."""
    pixels = np.column_stack([np.linspace(0, 1.0 + 1e-13, 4), np.full(4, 5.0)])
    for energy in (np.diag([1e9, 1e-9, 1e9]), np.diag([1e-200, 1e9, 1e-200])):
        for found in cut_into_bins(trail_of(pixels, energy), 0.25):
            assert (found.energy >= 0).all()
            assert (found.position[0] >= 0).all()
            assert (found.position[0] <= 1.0 + 1e-12).all()
            np.testing.assert_allclose(found.position[1], 5.0, rtol=1e-12)


def test_long_ways_come_in_pieces_that_fit_the_cache():
    pixels = np.random.default_rng(5).uniform(0, 1000, (2000, 2))
    found = list(cut_into_bins(trail_of(pixels, np.ones((1999, 3))), 1.0))
    assert max(len(one.length) for one in found) < 2 * BATCH
    np.testing.assert_allclose(sum(one.energy.sum() for one in found), 3 * 1999.0, rtol=1e-12)
