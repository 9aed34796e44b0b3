"""The constants that bound what is read and worked out -> one table."""

from dqpaint.brushes import images
from dqpaint.core import DEFAULT_MAX_SAMPLES, LARGEST_IMAGE, number_table, user_files
from dqpaint.core.inputs import xml_tree
from dqpaint.language.expansion import blocks, expander, includes
from dqpaint.language.imports import lettering, point_files
from dqpaint.language.imports.svg import guard
from dqpaint.language.pen import pen
from dqpaint.language.strokes import imported_strokes
from dqpaint.language.syntax import expressions, lexer, parser, source
from dqpaint.light.camera import views
from dqpaint.light.sources import from_motion
from dqpaint.motion import stroke_errors
from dqpaint.painting import film_file
from dqpaint.robots.loading import load_file
from dqpaint.robots.urdf import meshes, tree
from dqpaint.settings import file, groups
from dqpaint.studies.kinds import sweep

MB = 1e6


def rows():
    """What is bounded, the most of it, and the option that allows more."""
    return [
        ("a drawing, with each file it includes", source.MOST_BYTES / MB, "MB"),
        ("its lines, of all files together", includes.MOST_LINES, ""),
        ("its words and signs in one line", lexer.MOST_TOKENS, ""),
        ("files that include each other", includes.DEEPEST, "deep"),
        ("blocks, calls and files within each other", expander.DEEPEST, "deep"),
        ("blocks as they are written", parser.DEEPEST, "deep"),
        ("brackets in a formula", expressions.DEEPEST, "deep"),
        ("passes of a `repeat`", blocks.MOST_PASSES, ""),
        ("statements that are carried out", blocks.MOST_STATEMENTS, ""),
        ("strokes and ways between them", pen.MOST_SEGMENTS, ""),
        ("lines, curves and arcs of imported paths", imported_strokes.MOST_PIECES, ""),
        ("letters of one text", lettering.LONGEST, ""),
        ("a file of points", point_files.MOST_BYTES / MB, "MB"),
        ("its rows", point_files.MOST_ROWS, ""),
        ("an SVG", guard.MOST_BYTES / MB, "MB"),
        ("its elements, as they come by `use`", guard.MOST_ELEMENTS, ""),
        ("an image for a brush", LARGEST_IMAGE / MB, "MB"),
        ("its pixels", images.MOST_PIXELS, ""),
        ("flashes of a strobe or a PWM", from_motion.MOST_FLASHES, ""),
        ("how long a drawing takes", stroke_errors.MOST_SECONDS, "s"),
        ("samples of a drawing", DEFAULT_MAX_SAMPLES, "", "`--max-samples`"),
        ("memory of a painting, as forecast", groups.DEFAULT_MEMORY, "GB", "`--max-memory`"),
        ("how long a run takes", groups.DEFAULT_TIMEOUT, "s", "`--timeout`"),
        ("a side of a picture", groups.LARGEST, "px"),
        ("views of an orbit", views.MOST_ORBIT_VIEWS, ""),
        ("a film", film_file.LARGEST_FILE / MB, "MB"),
        ("its arrays, unpacked", film_file.LARGEST_UNPACKED / MB, "MB"),
        ("a settings file", file.LARGEST / MB, "MB"),
        ("a table of numbers: recorded runs, disturbances", number_table.LARGEST_FILE / MB, "MB"),
        ("a Python file with a law, a plant or a brush", user_files.LARGEST_FILE / MB, "MB"),
        ("a robot card", load_file.LARGEST_CARD / MB, "MB"),
        ("a URDF", tree.LARGEST_FILE / MB, "MB"),
        ("its links", tree.MOST_LINKS, ""),
        ("joints that move the light", tree.MOST_JOINTS, ""),
        ("lengths in it", tree.FARTHEST, "m"),
        ("elements of an XML file", xml_tree.MOST_ELEMENTS, ""),
        ("elements within each other", xml_tree.DEEPEST, "deep"),
        ("a mesh or its texture", meshes.LARGEST_FILE / MB, "MB"),
        ("triangles of all meshes of an arm", meshes.MOST_TRIANGLES, ""),
        ("pixels of a texture", meshes.MOST_PIXELS, ""),
        ("reading Collada files, in a process of its own", meshes.LONGEST_TRIAL, "s"),
        ("its address space", meshes.LARGEST_TRIAL / 1e9, "GB"),
        ("runs of a sweep", sweep.MOST_RUNS, ""),
    ]


def cells():
    """The rows as the table shows them."""
    return [
        [what, f"{most:,.10g} {unit}".strip(), *(more or [""])]
        for what, most, unit, *more in rows()
    ]
