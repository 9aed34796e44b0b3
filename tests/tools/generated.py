"""The generated tables of the pages: `python -m tests.tools.generated` writes them."""

import json
import subprocess
import sys
from keyword import iskeyword
from math import ceil, floor
from pathlib import Path

import numpy as np

END = "<!-- end -->"
ROOT = Path(__file__).parents[2]
CASES = ROOT / "tests/references/cases.toml"
CASE_SIZE = {"width": 400, "height": 225}  # all of them stay below 3.5 MB


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def statements():
    from dqpaint.language.vocabulary.words import STATEMENTS

    rows = [
        [f"`{s.word}`", s.meaning, " ".join(s.parts), f"`{s.example}`"] for s in STATEMENTS.values()
    ]
    return table(["statement", "what it says", "its parts", "for example"], rows)


def parts():
    from dqpaint.language.vocabulary.words import PARTS

    rows = [[f"`{p.word}`", p.meaning, f"`{p.example}`"] for p in PARTS.values()]
    return table(["part", "what it says", "for example"], rows)


def values():
    from dqpaint.language.vocabulary.units import UNITS
    from dqpaint.language.vocabulary.words import CONSTANTS, FUNCTIONS, PROFILES

    profiles = [name + end for name, ends in PROFILES.items() for end in ends]
    kinds = {
        "units": [f"`{u}`" for u in UNITS],
        "constants": [f"`{c}`" for c in CONSTANTS],
        "profiles": [f"`{profile}`" for profile in profiles],
        "functions": [f"`{call}`" for call in FUNCTIONS.values()],
    }
    return table(["", ""], [[kind, " ".join(words)] for kind, words in kinds.items()])


def controllers():
    from dqpaint.controllers import CONTROLLERS
    from dqpaint.controllers.base.gains import shown
    from dqpaint.core.texts.explanations import read_sections

    rows = []
    for law in CONTROLLERS.values():
        gains = ", ".join(
            f"`{name} = {shown(f.default)}`" for name, f in law.gains.model_fields.items()
            if f.default is not None
        )  # fmt: skip
        equation = read_sections(law.docstring).equations[0]
        name = f"[`{law.name}`](equations.md#{law.name})"
        rows.append([name, law.summary, formula(equation), gains, law.source])
    return table(["name", "what it does", "equation", "gains", "from"], rows)


def formula(equation):
    """An equation within a line, as GitHub's Markdown has it: not touched by other marks."""
    from dqpaint.core.texts.mathematics import latex_equation

    return f"$`{latex_equation(equation)}`$"


def explanations():
    """Everything that `dqpaint explain` explains, with its equations in LaTeX."""
    from dqpaint.cli import explaining

    parts = []
    for kind in explaining.NEEDED:
        parts.append(f"## {kind.capitalize()}s")
        parts += [explanation(one) for one in explaining.all_explained(kind)]
    return "\n\n".join(parts)


def explanation(one):
    from dqpaint.cli.listing import value_line
    from dqpaint.core.texts.mathematics import latex_block, unicode_prose

    sections = one.sections
    parts = [f"### {one.name}", sections.summary.rstrip(".") + "."]
    parts += [latex_block(sections.equations)]
    texts = {
        label: unicode_prose(text).replace("*", r"\*") for label, text in sections.texts.items()
    }
    about = [f"- *{label}*: {text}" for label, text in texts.items()]
    about += [f"- *source*: {one.source}"] if one.source else []
    values = ", ".join(f"`{value_line(v).replace('  ', '` (', 1)})" for v in one.values)
    about += [f"- *{'gains' if one.kind == 'law' else 'values'}*: {values}"] if values else []
    parts.append("\n".join(about))
    parts.append("```sh\n" + "\n".join(sections.try_) + "\n```")
    return "\n\n".join(parts)


def robots():
    from dqpaint.robots.model.card import card_names, read_card

    cards = [read_card(name) for name in card_names()]
    rows = [[f"`{c.name}`", c.title, str(c.joints), c.origin, c.motors] for c in cards]
    return table(["robot", "", "joints", "from", "motors of `servo`"], rows)


def stars():
    """The star by every arm, bounds rounded away from the good side.

    The row of an arm whose package is not installed stays as it is.
    """
    import dqpaint
    from dqpaint.robots.model.card import card_names, read_card

    page = DOCS / "robots.md"
    before = {line.split("|")[1].strip(): line for line in page.read_text("utf-8").splitlines()
              if line.startswith("| `") and line.count("|") == 6}  # fmt: skip
    rows = []
    for card in map(read_card, card_names()):
        if card.missing:
            line = before[f"`{card.name}`"]
            rows.append([cell.strip() for cell in line.strip("|").split("|")])
            continue
        errors = []
        for plant in ("ideal", "stiff"):
            run = dqpaint.draw("star", robot=card.name, plant=plant, size=(64, 36))
            assert not run.limits
            errors.append(ceil(run.table["position_error_m"].max() * 1e5) / 100)
        joints = run.track.posture
        margin = np.degrees(np.minimum(joints - card.lower, card.upper - joints).min())
        least = floor(100 * run.track.manipulability.min()) / 100
        rows.append([f"`{card.name}`", *(f"{e:.2f} mm" for e in errors), f"{floor(margin)} deg",
                     f"{least:.2f}"])  # fmt: skip
    heads = ["star by", "`ideal`, error below", "`stiff`", "joints off limits by", "manipulability"]
    return table(heads, rows)


def hard():
    """Drawings an arm cannot follow as they are: what the options make of them."""
    import tempfile

    from dqpaint import api
    from dqpaint.language import ScriptError
    from tests.support.hard_drawings import BEYOND, FAST, far_out, past_a_singularity

    rows = []
    for name, text, start in (
        ("too fast", FAST, "first"), ("1 deg beside a singularity, 300 mm/s",
        past_a_singularity(), "first"), ("across the end of joint 7", BEYOND, "home"),
        ("10 % out of reach", far_out(), "first"),
    ):  # fmt: skip
        cells = []
        for how in ("clip", "slow", "stop"):
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "t.traj"
                file.write_text(text)
                try:
                    run = api.draw(file, on_limit=how, start=start, plant="ideal", size=(64, 36))
                except ScriptError as problem:
                    cells.append(problem.diagnostics[0].code)
                    continue
            worst = run.table["position_error_m"].max() * 1e3
            turned = np.degrees(run.table["orientation_error_rad"].max())
            told = f"{float(f'{worst:.2g}'):g} mm" + (f", {turned:.2g} deg" if turned > 1 else "")
            longer = run.retiming.extra_time if run.retiming else 0.0
            cells.append(told + (f", {longer:.1f} s longer" if longer else ""))
        rows.append([name, *cells])
    return table(["drawing", "`clip`", "`slow`", "`stop`"], rows)


def springs():
    """The compliant arms on half a circle: error, sag, and where a gain makes them oscillate."""
    from tests.support.compliant_loop import ARMS, error

    rows = []
    for values, law, gains in (
        ("frequency=40", "p", (20,)), ("frequency=40", "pff", (20, 40, 60)),
        ("frequency=80", "pff", (40, 60, 125)), ("frequency=40,damper=ground", "pff", (20, 30)),
        ("frequency=80,damper=ground", "pff", (40, 60)),
        ("frequency=40,encoder=motor", "pff", (20,)),
        ("frequency=40,encoder=motor,gravity=0", "pff", (20,)),
    ):  # fmt: skip
        calm = [np.inf] * len(ARMS)
        for gain in gains:
            cells = []
            for i, arm in enumerate(ARMS):
                far, restless = error(arm, values, law, gain)
                oscillates = restless > 10 * calm[i] and far > 2
                calm[i] = min(calm[i], restless)
                cells.append(
                    "oscillates"
                    if oscillates
                    else f"{float(f'{far:.{2 if far > 1 else 1}g}'):g} mm"
                )
            rows.append([f"`compliant:{values}`", f"`{law}`", str(gain), *cells])
    return table(["plant", "law", "k, 1/s", *(f"`{name}`" for name in ARMS)], rows)


def plants():
    from dqpaint.plants import PLANTS

    rows = [
        [f"`{name}`", plant.__doc__.splitlines()[0], _values(plant.options)]
        for name, plant in PLANTS.items()
    ]
    return table(["plant", "", "values"], rows)


def disturbances():
    from dqpaint.disturbances import DISTURBANCES

    rows = [
        [f"`{name}`", model.__doc__.splitlines()[0], _values(model)]
        for name, model in DISTURBANCES.items()
    ]
    return table(["disturbance", "", "values"], rows)


def tasks():
    from dqpaint.robots.model import TASKS

    rows = [[f"`{name}`", str(task.dimensions), task.about] for name, task in TASKS.items()]
    return table(["`--task`", "numbers", ""], rows)


def resolvers():
    from dqpaint.robots.resolvers import RESOLVERS

    rows = []
    for name, resolver in RESOLVERS.items():
        values = [
            f"`{value}`" + (f" = {field.default:g}" if field.default else "")
            for value, field in resolver.options.model_fields.items()
        ]
        rows.append([f"`{name}`", resolver.__doc__.splitlines()[0], ", ".join(values)])
    return table(["`--resolver`", "", "values"], rows)


def null():
    from dqpaint.robots.kinematics.nullspace import OBJECTIVES

    rows = [
        [
            f"`{name}`",
            one.__doc__.splitlines()[0],
            f"{one.default_gain:g} {one.unit}" if one.default_gain else "",
        ]
        for name, one in OBJECTIVES.items()
    ]
    return table(["`--null`", "", "gain"], rows)


def _values(model):
    fields = model.model_fields.items() if model else ()
    return ", ".join(f"`{name}` ({field.description})" for name, field in fields)


def brushes():
    from dqpaint.brushes import BRUSHES

    rows = [
        [
            f"`{name}`",
            kind.__doc__.splitlines()[0],
            " ".join(f"`{key}`" for key in kind.model_fields),
        ]
        for name, kind in BRUSHES.items()
    ]
    return table(["brush", "", "its choices"], rows)


def looks():
    from dqpaint.light.film.looks import LOOKS

    return table(["look", ""], [[f"`{n}`", k.__doc__.splitlines()[0]] for n, k in LOOKS.items()])


def options():
    """The options of the command line, each with the commands that take it."""
    from dqpaint.settings import COMMANDS, settings_of

    rows = []
    for setting in settings_of(*COMMANDS["draw"]):
        option, default = setting.option, setting.default
        forms = [f"--{setting.name}" + (f" {option.metavar}" if option.metavar else "")]
        forms += [f"--{option.variant.name}"] if option.variant else []
        usual = option.unsaid or ("" if default in (None, False) else f"`{default}`")
        forms = ", ".join(f"`{form}`".replace("|", "\\|") for form in forms)
        takers = ", ".join(name for name, groups in COMMANDS.items() if setting.group in groups)
        rows.append([forms, option.help.replace("|", "\\|"), usual, takers])
    return table(["option", "", "default", "commands"], rows)


OPTIONS = ROOT / "dqpaint/settings/options.py"
OPTIONS_HEAD = '''"""Groups of `model` -> keywords in Python, as type checkers and editors see them.

`python -m tests.tools.generated` writes it again.
"""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, TypedDict
'''


def keyword_types():
    """The module that says to type checkers which keywords there are."""
    from dqpaint.settings.commands import COMMANDS, OF_RUN
    from dqpaint.settings.declaration import settings_of
    from dqpaint.settings.keywords import python_type

    def name(group):
        return group.__name__.replace("Settings", "Options")

    parts = [OPTIONS_HEAD]
    for group in COMMANDS["draw"]:
        fields = [f"    {s.keyword}: {python_type(s)} | None" for s in settings_of(group)]
        head = f'class {name(group)}(TypedDict, total=False):\n    """{group.__doc__}"""\n'
        parts.append("\n".join([head, *fields, ""]))
    whole = {n.title(): COMMANDS[n] for n in ("draw", "preview", "develop", "replay")} | {
        "Run": OF_RUN
    }
    about = {command: f"Of `{command.lower()}`." for command in whole}
    about["Run"] = "Of a run without pictures."
    for command, groups in whole.items():
        bases = ", ".join(map(name, groups))
        parts.append(f'class {command}Options({bases}):\n    """{about[command]}"""\n')
    return _formatted("\n\n".join(parts), OPTIONS)


STUDY_OPTIONS = ROOT / "dqpaint/studies/options.py"
STUDY_OPTIONS_HEAD = '''"""Parameters of studies -> keywords in Python, as type checkers see them.

`python -m tests.tools.generated` writes it again.
"""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, Literal

from dqpaint.settings import DrawOptions, RunOptions
from dqpaint.settings import ReplayOptions as OfReplay
'''


def study_keyword_types():
    """The module that says to type checkers which keywords the studies of dqpaint have."""
    from dqpaint.settings.keywords import python_type
    from dqpaint.studies.declared import STUDIES

    bases = {"compare": "DrawOptions", "sweep": "DrawOptions", "tune": "RunOptions",
             "replay": "OfReplay"}  # fmt: skip
    by_place = {"compare": "controllers", "sweep": "vary", "tune": "vary"}
    parts = [STUDY_OPTIONS_HEAD]
    for name, base in bases.items():
        others = [s for s in STUDIES[name].parameters() if s.keyword != by_place.get(name)]
        fields = [f"    {one.keyword}: {python_type(one)} | None" for one in others]
        head = f'class {name.title()}Options({base}, total=False):\n    """Of `{name}`."""\n'
        parts.append("\n".join([head, *fields, ""]))
    return _formatted("\n\n".join(parts), STUDY_OPTIONS)


def _formatted(text, place):
    """As ruff lays it out."""
    return subprocess.run(
        [sys.executable, "-m", "ruff", "format", "--stdin-filename", str(place), "-"],
        input=text, capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip


def columns():
    from dqpaint.metrics import all_columns

    rows = [[f"`{one.headers}`", one.meaning] for one in all_columns() if not one.motion_only]
    return table(["column", ""], rows)


def figures():
    from dqpaint.metrics import all_figures

    rows = [[f"`{name}`", one.heading, one.meaning] for name, one in all_figures().items()]
    return table(["figure", "shown as", ""], rows)


def messages():
    from dqpaint.diagnostics.catalogue import explanations

    rows = [
        [f"[`{e.code}`](MESSAGES.md#{e.code.lower()})", e.title] for e in explanations().values()
    ]
    return table(["code", "what it is about"], rows)


def rules():
    from dqpaint.diagnostics.catalogue import explanations

    return "\n".join(rule(e) for e in explanations().values())


def rule(explanation):
    """One message as its part of the page, under its code alone, so that it can be linked."""
    parts = [f"## {explanation.code}", f"**{explanation.title}**", explanation.says]
    for title, text in (("Wrong:", explanation.wrong), ("Right:", explanation.right)):
        parts += [title, f"```text\n{text}\n```"] if text else []
    for name, text in explanation.files.items():
        parts.append(f"with `{name}` beside it:\n\n```text\n{text.strip()}\n```")
    return "\n\n".join(parts) + "\n"


def limits():
    """What is bounded, and the option that allows more."""
    from tests.tools.limits import cells

    return table(["what", "at the most", "more by"], cells())


DOCS = ROOT / "docs"
PAGES = {
    DOCS / "laws.md": [controllers, disturbances],
    DOCS / "robots.md": [robots, plants, null, tasks, resolvers],
    DOCS / "light.md": [brushes, looks],
    DOCS / "options.md": [options],
    DOCS / "figures.md": [columns, figures],
    DOCS / "equations.md": [explanations],
    DOCS / "limits.md": [limits],
    ROOT / "trajectories/README.md": [messages, statements, parts, values],
    ROOT / "trajectories/MESSAGES.md": [rules],
}
SLOW_TABLES = {DOCS / "robots.md": [stars, springs, hard]}


def renewed(page, tables=PAGES):
    text = page.read_text("utf-8")
    for make in tables[page]:
        mark = f"<!-- {make.__name__} -->"
        before, found, rest = text.partition(mark)
        assert found, mark
        after = rest[rest.index(END) :]
        text = f"{before}{mark}\n{make()}\n{after}"
    return text


def cases():
    """The gallery as cases of `dqpaint verify tests/references`."""
    from dqpaint.studies.gallery import read_shots

    lines = ["# The pictures of the gallery, small. Written by python -m tests.tools.generated."]
    for shot in read_shots():
        lines += ["", f"[{shot.name}]", f"drawing = {json.dumps(shot.example)}"]
        choices = {**shot.options, **CASE_SIZE}
        lines += [f"{name} = {json.dumps(value)}" for name, value in choices.items()]
    return "\n".join(lines) + "\n"


RECORD = ROOT / "docs/summary.schema.json"


def summary_schema():
    """The JSON Schema of a run's summary."""
    from dqpaint.outputs.summary_shape import json_schema

    return json.dumps(json_schema(), indent=1) + "\n"


STUB = ROOT / "dqpaint/language/writing/statements.pyi"
STUB_HEAD = '''"""The statements as methods of a drawing, for editors and type checkers.

Written by python -m tests.tools.generated from the tables of the language.
"""

# ruff: noqa: E501
# fmt: off
from contextlib import AbstractContextManager
from typing import Any

class Statements:
'''


def stub():
    """The methods of a drawing, with the parts of each statement as keywords."""
    from dqpaint.language.vocabulary.words import PARTS, STATEMENTS
    from dqpaint.language.writing.builder import METHODS, example_call

    text = STUB_HEAD
    for method, word in METHODS.items():
        known = STATEMENTS[word]
        given = ["self"] + ["*values: Any"] * bool(known.head) + ["*"] * (not known.head)
        for part in known.parts:
            name = f"{part}_" if iskeyword(part) else part
            given.append(f"{name}: {'bool' if PARTS[part].takes == 'flag' else 'Any'} = ...")
        answer = "AbstractContextManager[None]" if known.block else "None"
        text += f"    def {method}({', '.join(given).removesuffix(', *')}) -> {answer}:\n"
        meaning = known.meaning[0].upper() + known.meaning[1:]
        text += f'        """{meaning}: `{example_call(word)}`."""\n'
    return text


if __name__ == "__main__":
    STUB.write_text(stub(), "utf-8")
    CASES.write_text(cases(), "utf-8")
    RECORD.write_text(summary_schema(), "utf-8")
    OPTIONS.write_text(keyword_types(), "utf-8")
    STUDY_OPTIONS.write_text(study_keyword_types(), "utf-8")
    for tables in (PAGES, SLOW_TABLES):
        for page in tables:
            page.write_text(renewed(page, tables), "utf-8")
