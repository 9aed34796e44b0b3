"""The declaration of a study -> its command, its call from Python, and a finished study.

What runs it is imported when it is carried out: help of a study needs its declaration alone.

A study is a model whose fields, each with an `Option`, are its parameters, and which names the
groups of settings that it takes besides:

    @STUDIES.add("twice")
    class Twice(RepeatedStudy):
        '''Draw a drawing with two laws.'''

        other: Annotated[str, Option("the second law", "NAME")] = "p"

        def carry_out(self, request: StudyRequest) -> StudyResult: ...

is `dqpaint twice FILE --other NAME` and `dqpaint.study("twice", drawing, other="p")`.
"""

import dataclasses
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple

from pydantic import BaseModel, ConfigDict

from dqpaint.core import Folder, subclass
from dqpaint.errors import UsageError
from dqpaint.settings import (
    COMMANDS,
    DEFAULT_CONTROLLER,
    Option,
    Setting,
    check_keywords,
    settings_of,
    validated,
)

if TYPE_CHECKING:
    from dqpaint.language.writing import builder
    from dqpaint.studies.kinds import StudyRequest, StudyResult
    from dqpaint.studies.runner.reporter import Reporter

FORMATS = ("tex", "pdf", "svg")
"""What a study can write besides PNG, CSV and Markdown."""
VARY = "str | Sequence[str] | Mapping[str, Any]"
"""The type of what is varied, from Python."""


class Subject(NamedTuple):
    """What a study is about: the argument of its command; `default` None must be given."""

    metavar: str
    help: str
    default: str | None = None


class Study(BaseModel):
    """Parameters of a study, and how it is carried out.

    The first line of the docstring is what lists and help say of it.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    subject: ClassVar[Subject] = Subject("FILE", "a .traj file, or an example's name")
    groups: ClassVar[tuple[type[BaseModel], ...]] = COMMANDS["draw"]
    """The groups of settings that it takes, too."""
    replaced: ClassVar[tuple[str, ...]] = ()
    """Settings that the command line has not, for it has parameters in their place."""
    defaults: ClassVar[dict[str, Any]] = {}
    """Of settings, where they are not those of a drawing."""
    examples: ClassVar[str] = ""
    """Of the command, at the end of its help."""
    whole: ClassVar[bool] = True
    """Whether what is not said has the default of a drawing, or comes from a file of settings."""

    jobs: Annotated[int | None, Option("processes", "N", unsaid="all cores")] = None
    cluster: Annotated[
        str | None, Option("address of a Dask scheduler, instead of --jobs", "ADDRESS")
    ] = None
    folder: Annotated[
        Any,
        Option(
            "folder of the study; a stopped one resumes",
            "FOLDER",
            name="out",
            python="str | PathLike[str]",
        ),
    ] = None

    @classmethod
    def parameters(cls) -> list[Setting]:
        """Its parameters, its own first."""
        return sorted(settings_of(cls), key=lambda one: one.field in Study.model_fields)

    @classmethod
    def settings(cls) -> list[Setting]:
        """The settings that it takes."""
        return list(settings_of(*cls.groups))

    @classmethod
    def default_folder(cls, name: str, subject: str) -> Path:
        """Where the command writes if no folder is given."""
        return Path(f"{Path(subject).stem}-{name}")

    @abstractmethod
    def carry_out(self, request: "StudyRequest") -> "StudyResult":
        """Carry the study out; `request.cells` does its runs.

        Raises:
            DqpaintError: a fault in the drawing, the choices or the folder.
        """


def _figure(name: object) -> str:
    from dqpaint.studies.experiment import check_figure

    check_figure(str(name))
    return str(name)


def _formats(value: object) -> tuple[str, ...]:
    """The names of more files, from a text with commas or several.

    Raises:
        UsageError: one is none.
    """
    names = value.split(",") if isinstance(value, str) else value
    found = tuple(str(name).strip() for name in names) if isinstance(names, Sequence) else ()
    for name in found or ("",):
        if name not in FORMATS:
            raise UsageError(f"save '{str(value)[:40]}' is not of {', '.join(FORMATS)}")
    return found


def figure_option(help: str) -> Option:
    """The option of a parameter that is the name of a figure."""
    return Option(help, "NAME", read=_figure)


def _alternatives(
    metavar: str, help: str, unsaid: str = "", python: str = "Sequence[str] | str"
) -> Option:
    return Option(help, metavar, unsaid=unsaid, python=python)


class RepeatedStudy(Study):
    """A study that can do each run with several seeds."""

    runs: Annotated[int, Option("runs of each choice, with the seeds that follow --seed", "N")] = 1
    save: Annotated[
        Any,
        Option(
            "more files: tables as tex (booktabs), charts as pdf, svg",
            "tex,pdf,svg",
            read=_formats,
            python="Sequence[str] | str",
        ),
    ] = ()


class StudyOfAlternatives(RepeatedStudy):
    """A study of several laws, plants, arms or disturbances."""

    replaced = ("controller", "plant", "robot")

    controllers: Annotated[
        Any,
        _alternatives(
            "A,B(GAIN=VALUE),...",
            "the laws, with gains of their own",
            DEFAULT_CONTROLLER,
            "str | Callable[..., Any] | Sequence[str | Callable[..., Any]]",
        ),
    ] = None
    plants: Annotated[Any, _alternatives("A,B(KEY=VALUE),...", "the plants", "stiff")] = None
    robots: Annotated[Any, _alternatives("A,B,...", "the arms")] = None
    disturbs: Annotated[
        Any,
        _alternatives(
            "A(KEY=VALUE),...",
            "disturbances, one at a time: none,payload(2),payload(2)+latency(3)",
        ),
    ] = None

    @property
    def several(self) -> dict[str, Any]:
        """The alternatives by the names of their settings."""
        return {"controller": self.controllers, "plant": self.plants, "robot": self.robots,
                "disturb": self.disturbs}  # fmt: skip


STUDIES: Folder[type[Study]] = Folder(
    "study",
    "dqpaint.studies.declared",
    group="dqpaint.studies",
    adapt=lambda name, thing: subclass(Study, name, thing),  # type: ignore[type-abstract]
)


def run_study(
    study: str | type[Study],
    subject: "str | builder.Drawing",
    given: Mapping[str, Any],
    folder: Path,
    reporter: "Reporter | None" = None,
) -> "StudyResult":
    """Carry out a study.

    Args:
        study: its name in `STUDIES`, or its class.
        subject: what it is about.
        given: parameters and settings by their names in Python; None is not given.
        folder: of the study.
        reporter: shows how far it is; None: nobody.

    Raises:
        UsageError: an unknown study or parameter, or a value out of its range.
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    from dqpaint.studies.experiment import requests
    from dqpaint.studies.kinds import StudyRequest
    from dqpaint.studies.runner.reporter import SILENT

    kind = STUDIES[study] if isinstance(study, str) else study
    name = study if isinstance(study, str) else study.__name__.lower()
    own = {one.keyword: one.option for one in kind.parameters()}
    said = {key: value for key, value in given.items() if value is not None}
    check_keywords(name, said, kind.settings(), [*own, *(["settings"] if kind.whole else [])])
    parameters = {
        key: option.read(said[key]) if option.read else said[key]
        for key, option in own.items()
        if key in said
    }
    asked = validated(kind, parameters)
    choices = {key: value for key, value in said.items() if key not in own}
    crew = requests.workers(asked.jobs, asked.cluster)
    request = StudyRequest(name, subject, choices, folder, crew, reporter or SILENT)
    result = asked.carry_out(request)
    return dataclasses.replace(result, formats=tuple(getattr(asked, "save", ())))
