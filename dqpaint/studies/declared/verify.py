"""Parameters of `verify` -> a folder of pictures, drawn again and compared."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from dqpaint.settings import Option
from dqpaint.studies.declared.study import STUDIES, Study, Subject

if TYPE_CHECKING:
    from dqpaint.studies.kinds import StudyRequest
    from dqpaint.studies.kinds.verify import Verification


@STUDIES.add("verify")
class Verify(Study):
    """Draw a folder again and compare it with its references, gate by gate."""

    subject = Subject("FOLDER", "folder of drawings (or a cases.toml) and references", ".")
    groups = ()
    whole = False
    examples = "Examples:\n\n  dqpaint verify drawings/\n\n  dqpaint verify drawings/ --update"

    update: Annotated[bool, Option("make new references, and list what changed")] = False
    trust: Annotated[
        bool, Option("run the code that cases name, wherever it lies; see SECURITY.md")
    ] = False
    format: Annotated[
        Literal["text", "github", "sarif"],
        Option("how verdicts are printed; github and sarif are for code scanners",
               "text|github|sarif"),
    ] = "text"  # fmt: skip
    folder: Annotated[Any, Option("folder for pictures of differences", "FOLDER", name="out")] = (
        None
    )

    @classmethod
    def default_folder(cls, name: str, subject: str) -> Path:
        """Where the command writes if no folder is given."""
        return Path("verify-differences")

    def carry_out(self, request: "StudyRequest") -> "Verification":
        """Verify."""
        from dqpaint.studies.kinds.verify import Verification, update, verify

        folder = Path(str(request.subject))
        verdicts = verify(folder, request.jobs, self.update, request.reporter, self.trust)
        changes = tuple(update(verdicts, folder)) if self.update else None
        return Verification(
            name="verify", cells=(), folder=request.folder, verdicts=tuple(verdicts),
            changes=changes,
        )  # fmt: skip
