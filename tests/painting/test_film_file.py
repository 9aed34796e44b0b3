"""Films that are kept: developed again they are what they were, and files of others are refused."""

import io
import json
import sys
import tracemalloc
import zipfile

import cv2
import numpy as np
import pytest

import dqpaint
from dqpaint.cli import report
from dqpaint.diagnostics import SourceLine
from dqpaint.errors import DqpaintError
from dqpaint.outputs import files, registry
from dqpaint.painting import film_file, video
from dqpaint.painting.picture import linear_image
from dqpaint.painting.scene import Scene
from tests.support.work import Calls

TEXT = "period 20 ms\nline to (30, 10) mm in 1 s\nline by (0, -20) mm light red to blue\n"
CHOICES = {
    "plain": {},
    "bar": {"brush": "bar:length=100mm,leds=9", "view": "iso,front"},
    "told": {"colour_by": "position-error", "overlay": True, "magnify": 3.0, "ev": -1.0},
    "real": {"exposure": "f/8,iso100,50mm,0.05cd", "pwm": 100.0, "look": "aces", "noise": 3},
    "pixels": {"brush": "pixelstick:length=40mm,along=y", "starburst": 6},
}


@pytest.fixture(scope="module", params=CHOICES)
def painting(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("drawing") / "corner.traj"
    path.write_text(TEXT)
    return dqpaint.draw(
        path, controller="p", plant="ideal", size=(160, 90), **CHOICES[request.param]
    )


def test_a_film_developed_again_is_the_same_to_the_bit(painting, tmp_path):
    dqpaint.save(painting, f"{tmp_path}/a", "film")
    again = dqpaint.develop(tmp_path / "a-film.npz")
    assert len(again) == len(painting.pictures)
    for new, old in zip(again, painting.pictures, strict=True):
        assert np.array_equal(new.image, old.image)
        assert new.exposure_text == old.exposure_text


def test_the_tiff_is_the_linear_film_exactly(painting, tmp_path):
    dqpaint.save(painting, f"{tmp_path}/a", "film,hdr")
    read = cv2.imread(f"{tmp_path}/a-film.tiff", cv2.IMREAD_UNCHANGED)[..., ::-1]
    assert read.dtype == np.float32
    picture = painting.picture
    image = linear_image(
        painting.scene, picture.film, picture.exposure, picture.camera, painting.settings
    )
    ratio = read[image > 0] / image[image > 0]
    assert np.ptp(ratio) == 0
    assert np.log2(ratio[0]) == round(np.log2(ratio[0]))
    assert 0.7 < ratio[0] / (picture.exposure * 2.0**painting.settings.ev) < 1.42
    hdr = cv2.imread(f"{tmp_path}/a.hdr", cv2.IMREAD_UNCHANGED)[..., ::-1]
    scale = read.max(axis=2, keepdims=True)
    assert (np.abs(hdr - read) <= 0.01 * scale + 1e-6).all()


def test_what_is_asked_for_anew_is_as_if_it_had_been_drawn_so(tmp_path):
    (tmp_path / "corner.traj").write_text(TEXT)
    drawing = tmp_path / "corner.traj"
    first = dqpaint.draw(drawing, plant="ideal", size=(160, 90), brush="ribbon:length=30mm,along=y")
    dqpaint.save(first, f"{tmp_path}/a", "film")
    choices = {"size": (240, 135), "view": "20,30,orbit:3", "look": "agx", "ev": 0.5}
    again = dqpaint.develop(tmp_path / "a-film.tiff", **choices)  # the name of its picture will do
    drawn = dqpaint.draw(drawing, plant="ideal", brush="ribbon:length=30mm,along=y", **choices)
    for new, old in zip(again, drawn.pictures, strict=True):
        assert np.array_equal(new.image, old.image)
    real = dqpaint.develop(tmp_path / "a-film.npz", exposure="f/8,35mm,0.1cd")[0]
    assert real.exposure_text == "f/8, ISO 100, 35 mm, LED of 0.1 cd"
    auto = dqpaint.develop(tmp_path / "a-film.npz", exposure="auto")[0]
    assert np.array_equal(auto.image, first.image)


def test_developing_simulates_nothing_and_is_quick(tmp_path, monkeypatch):
    painting = dqpaint.draw("star", plant="ideal", size=(1280, 720))
    dqpaint.save(painting, f"{tmp_path}/a", "film")
    monkeypatch.setattr("dqpaint.simulation.closed_loop.track", None)
    dqpaint.develop(tmp_path / "a-film.npz")
    with Calls(10_000):
        dqpaint.develop(tmp_path / "a-film.npz", view="iso", look="clip")


def broken(tmp_path):
    painting = dqpaint.draw("star", plant="ideal", size=(64, 36))
    whole = film_file.encode(painting.scene, painting.settings)
    armed = film_file.encode(painting.scene, painting.settings, painting.arm_motion)
    arrays = dict(np.load(io.BytesIO(whole)))

    def again(**changed):
        file = io.BytesIO()
        np.savez(file, **{k: v for k, v in {**arrays, **changed}.items() if v is not None})
        return file.getvalue()

    about = str(arrays["about"])
    yield "empty", b""
    yield "text", b"line to (0, 0) mm\n"
    yield "cut", whole[: len(whole) // 2]
    yield "no arrays", again(front=None)
    yield "no about", again(about=None)
    yield "other schema", again(about=np.array(about.replace("dqpaint-film-1", "dqpaint-film-9")))
    yield "no json", again(about=np.array("{"))
    yield "wrong shape", again(**{"light0-pose": np.zeros((3, 7))})
    far = arrays["light0-pose"].copy()
    for fault in (np.nan, np.inf, 1e200, 0.0):
        yield f"pose {fault}", again(**{"light0-pose": far * fault})
    yield "complex", again(**{"light0-pose": far * (1 + 1j)})
    yield "text array", again(**{"light0-pose": far.astype(str)})
    yield "one number", again(**{"light0-pose": np.array(1.0)})
    yield "front nan", again(front=arrays["front"] * np.nan)
    yield "front short", again(front=arrays["front"][:2])
    yield "deep", again(about=np.array("[" * 100_000))
    yield "list", again(about=np.array("[1]"))
    facts = json.loads(about)
    for name, value in (
        ("period", 1e300),
        ("size", -1),
        ("size", 10.1),
        ("lobe", "q"),
        ("pwm", -5),
        ("joined", 2),
    ):
        one = {**facts["light"][0], name: value}
        yield name, again(about=np.array(json.dumps({**facts, "light": [one]})))
    for name, value in (("dimmer", -5), ("name", 5), ("light", {"a": 1}), ("legend", "x")):
        yield name, again(about=np.array(json.dumps({**facts, name: value})))
    header = io.BytesIO()
    form = {"descr": "<f8", "fortran_order": False, "shape": (10**12, 8)}
    np.lib.format.write_array_header_1_0(header, form)
    for name, member, instead in (
        ("huge header", "light0-pose.npy", header.getvalue()), ("no array", "front.npy", b"text"),
        ("nor in the arm", "arm-line.npy", b"text"), ("nor about", "about.npy", about.encode()),
    ):  # fmt: skip
        file = io.BytesIO()
        with zipfile.ZipFile(io.BytesIO(armed)) as old, zipfile.ZipFile(file, "w") as new:
            for one in old.namelist():
                new.writestr(one, instead if one == member else old.read(one))
        yield name, file.getvalue()
    yield "pickle", again(**{"light0-pose": np.array([{}], dtype=object)})


def test_files_that_are_no_films_are_refused_in_a_sentence(tmp_path):
    for name, data in broken(tmp_path):
        (tmp_path / "bad.npz").write_bytes(data)
        with pytest.raises(DqpaintError) as caught:
            dqpaint.develop(tmp_path / "bad.npz")
        assert "film" in str(caught.value), name
    with pytest.raises(DqpaintError, match="cannot be read"):
        dqpaint.develop(tmp_path / "none.npz")


@pytest.mark.parametrize("fits", [True, False])
def test_a_film_is_bounded_before_it_is_unpacked(tmp_path, monkeypatch, fits):
    painting = dqpaint.draw("star", plant="ideal", size=(64, 36))
    path = tmp_path / "a.npz"
    path.write_bytes(film_file.encode(painting.scene, painting.settings))
    with zipfile.ZipFile(path) as packed:
        size = sum(member.file_size for member in packed.infolist())
    monkeypatch.setattr(film_file, "LARGEST_UNPACKED", size if fits else size - 1)
    if fits:
        film_file.read(str(path))
        return
    with pytest.raises(DqpaintError, match="unpacked"):
        film_file.read(str(path))
    with pytest.raises(DqpaintError, match="the film would take"):
        film_file.encode(painting.scene, painting.settings)


@pytest.mark.slow
def test_a_bomb_of_a_film_is_not_inflated(tmp_path):
    """A megabyte of file, a gigabyte of zeros."""
    path = tmp_path / "a.npz"
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed,
        packed.open("light0-colours.npy", "w", force_zip64=True) as member,
    ):
        for _ in range(1000):
            member.write(bytes(1_000_000))
    tracemalloc.start()
    with pytest.raises(DqpaintError, match="unpacked"):
        film_file.read(str(path))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10_000_000


def test_lines_of_included_files_are_kept(tmp_path):
    (tmp_path / "petal.traj").write_text("\nline by (30, 0) mm\n")
    (tmp_path / "a.traj").write_text('include "petal.traj"\nline by (0, 9) mm\n')
    painting = dqpaint.draw(tmp_path / "a.traj", plant="ideal", size=(64, 36))
    whole = film_file.encode(painting.scene, painting.settings, painting.arm_motion)
    (tmp_path / "a.npz").write_bytes(whole)
    source = film_file.read(str(tmp_path / "a.npz")).arm_motion.source
    assert source.lines == (SourceLine(0, 2), SourceLine(1, 2))
    np.testing.assert_array_equal(source.index, painting.motion.source.index)
    arrays = dict(np.load(io.BytesIO(whole)))
    for wrong in (arrays["arm-file"][1:], arrays["arm-file"] * 1.0):
        np.savez(tmp_path / "bad.npz", **{**arrays, "arm-file": wrong})
        with pytest.raises(DqpaintError, match="is not a film"):
            film_file.read(str(tmp_path / "bad.npz"))


def test_a_film_without_light_is_told_without_a_share(tmp_path):
    painting = dqpaint.draw("star", plant="ideal", size=(64, 36))
    arrays = dict(np.load(io.BytesIO(film_file.encode(painting.scene, painting.settings))))
    dark = {k: v * 0 if k == "light0-colours" else v for k, v in arrays.items()}
    np.savez(tmp_path / "dark.npz", **dark)
    pictures = dqpaint.develop(tmp_path / "dark.npz")
    assert report.light_line(pictures[0]) == "none: no lamp shines towards the camera"


def test_a_device_is_no_place_for_a_picture():
    with pytest.raises(DqpaintError, match="'/dev/null'"):
        files.stem_for("/dev/null", "star")


def test_choices_are_checked(tmp_path):
    painting = dqpaint.draw("star", plant="ideal", size=(64, 36))
    dqpaint.save(painting, f"{tmp_path}/a", "film")
    for choice, says in [({"look": "x"}, "look"), ({"view": "x"}, "view"),
                         ({"starburst": 1}, "starburst 1"), ({"ev": 99.0}, "ev")]:  # fmt: skip
        with pytest.raises(DqpaintError, match=says):
            dqpaint.develop(tmp_path / "a-film.npz", **choice)


def test_a_video_grows_to_the_picture(monkeypatch):
    painting = dqpaint.draw("star", plant="ideal", size=(161, 90), overlay=True)
    monkeypatch.setattr(video, "LONGEST_VIDEO", 1.0)
    monkeypatch.setattr(video, "SHORTEST_VIDEO", 0.5)
    told = []
    frames = list(
        video.frames(painting.scene, painting.picture, painting.settings, 12, told.append)
    )
    assert len(frames) == 12
    assert told == sorted(told)
    assert told[-1] <= 1.0
    light = [frame.astype(float).sum() for frame in frames]
    assert (np.diff(light) > -0.001 * light[-1]).all()
    assert np.array_equal(frames[-1], painting.image)
    assert (
        np.abs(frames[-2].astype(int) - frames[-1]).mean()
        < np.abs(frames[0].astype(int) - frames[-1]).mean()
    )


def test_what_has_shone_by_the_last_frame_is_the_film(monkeypatch):
    """The pieces of a video add up to the whole film, whatever the brush."""
    from dqpaint.light.film.film import FilmAccumulator

    for brush in ("point", "ball:size=5mm", "bar:length=50mm", "pixelstick:length=40mm,along=y"):
        painting = dqpaint.draw("star", plant="ideal", size=(160, 90), brush=brush)
        exposing = FilmAccumulator(painting.picture.camera)
        for sweep in painting.scene.light:
            n = len(sweep.colours)
            for i in range(7):
                for piece in sweep.emission_to(
                    painting.picture.camera, False, slice(n * i // 7, n * (i + 1) // 7)
                ):
                    exposing.add(piece)
        film = exposing.film()
        np.testing.assert_allclose(film.on_film, painting.film.on_film, rtol=1e-9)
        off = np.abs(film.planes - painting.film.planes).sum()  # bins end where frames do
        assert off < 0.03 * painting.film.planes.sum(), brush


@pytest.mark.slow
def test_movies_are_written_in_formats_that_play(tmp_path, monkeypatch):
    monkeypatch.setattr(video, "LONGEST_VIDEO", 1.0)
    painting = dqpaint.draw("star", plant="ideal", size=(161, 91))
    told = []
    movies = registry.make_files(registry.choose_writers("video,webp,gif"), painting, told.append)
    assert list(movies) == [".webm", ".webp", ".gif"]
    assert len(told) > 20
    assert movies[".webm"][:4] == b"\x1a\x45\xdf\xa3"  # EBML
    (tmp_path / "a.webm").write_bytes(movies[".webm"])
    film = cv2.VideoCapture(str(tmp_path / "a.webm"))
    assert int(film.get(cv2.CAP_PROP_FOURCC)).to_bytes(4, "little") in (b"VP90", b"vp09")
    frames = []
    while (read := film.read())[0]:
        frames.append(read[1])
    assert len(frames) == 25 + round(video.FINAL_TIME * 25)
    assert frames[-1].shape == (90, 160, 3)
    assert np.abs(frames[-1][..., ::-1].astype(int) - painting.image[:90, :160]).mean() < 4
    assert movies[".webp"][8:12] == b"WEBP"
    done, animation = cv2.imdecodeanimation(np.frombuffer(movies[".webp"], np.uint8))
    assert done
    assert len(animation.frames) == 12
    done, animation = cv2.imdecodeanimation(np.frombuffer(movies[".gif"], np.uint8))
    assert done
    assert len(animation.frames) == 12
    last = animation.frames[-1][..., 2::-1].astype(int)
    assert np.abs(last - painting.image).mean() < 6


@pytest.fixture
def ffmpeg(tmp_path, monkeypatch):
    """A stand-in for ffmpeg, by its text; it is all that the search path has."""

    def stands_in(text):
        program = tmp_path / "ffmpeg"
        program.write_text(f"#!{sys.executable}\nimport sys, pathlib\n{text}\n")
        program.chmod(0o755)
        monkeypatch.setenv("PATH", str(tmp_path))

    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(video, "SHORTEST_VIDEO", 0.2)
    monkeypatch.setattr(video, "LONGEST_VIDEO", 0.2)
    return stands_in


def test_mp4_without_an_ffmpeg_is_vp9(ffmpeg, tmp_path):
    painting = dqpaint.draw("star", plant="ideal", size=(161, 91))
    (movie,) = registry.make_files(registry.choose_writers("mp4"), painting).values()
    assert movie[4:8] == b"ftyp"
    (tmp_path / "a.mp4").write_bytes(movie)
    film = cv2.VideoCapture(str(tmp_path / "a.mp4"))
    frames = []
    while (read := film.read())[0]:
        frames.append(read[1])
    assert len(frames) == 5 + round(video.FINAL_TIME * 25)
    assert np.abs(frames[-1][..., ::-1].astype(int) - painting.image[:90, :160]).mean() < 4


def test_mp4_by_an_ffmpeg_has_every_frame(ffmpeg):
    """It is asked for H.264 and given the pixels of each frame, the last one held."""
    painting = dqpaint.draw("star", plant="ideal", size=(161, 91))
    ffmpeg("pathlib.Path(sys.argv[-1]).write_bytes("
           "' '.join(sys.argv[1:-1]).encode() + b'|' + sys.stdin.buffer.read())")  # fmt: skip
    (movie,) = registry.make_files(registry.choose_writers("mp4"), painting).values()
    asked, _, data = movie.partition(b"|")
    assert b"-video_size 160x90 -framerate 25 " in asked
    assert b"-c:v libx264 " in asked
    frames = np.frombuffer(data, np.uint8).reshape(-1, 90, 160, 3)
    assert len(frames) == 5 + round(video.FINAL_TIME * 25)
    np.testing.assert_array_equal(frames[-1][..., ::-1], painting.image[:90, :160])


@pytest.mark.parametrize("text", [
    "sys.exit('Unknown encoder')",
    "sys.stdin.buffer.read(); sys.exit('Unknown encoder')",
])  # fmt: skip
def test_an_ffmpeg_that_fails_is_said(ffmpeg, text):
    painting = dqpaint.draw("star", plant="ideal", size=(161, 91))
    ffmpeg(text)
    with pytest.raises(DqpaintError, match="Unknown encoder; --save video"):
        registry.make_files(registry.choose_writers("mp4"), painting)


def test_a_scene_is_plain_data():
    assert Scene.__dataclass_params__.frozen
