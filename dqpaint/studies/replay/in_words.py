"""A replay's verdicts -> what of the paper holds, in a sentence, and what follows from it."""

from collections.abc import Sequence

from dqpaint.studies.replay.claims import ClaimVerdict
from dqpaint.studies.replay.papers import Claim

WAYS = {
    "holds": ("holds", "hold"), "in part": ("holds in part", "hold in part"),
    "fails": ("does not", "do not"), "not shown": ("is not shown", "are not shown"),
    "no numbers": ("cannot be told", "cannot be told"),
}  # fmt: skip


def in_words(
    verdicts: Sequence[tuple[Claim, ClaimVerdict, ClaimVerdict]], where: str, lost: int, cells: int
) -> str:
    """The sentence that ends a replay.

    Args:
        verdicts: of each claim: the claim, by the paper's numbers, by ours.
        where: on what it was run, such as `on the paper's own arm, `; empty where nothing was.
        lost: how many cells have no result.
        cells: of how many.
    """
    theirs = [(claim, ours) for claim, _, ours in verdicts if claim.where]
    if not theirs:
        return ""
    parts = []
    for word, (one, many) in WAYS.items():
        these = [claim.says for claim, ours in theirs if ours.word == word]
        count = len(these)
        if these:
            if word == "no numbers" and lost:
                these = [*these, f"{lost} of {cells} cells have no result"]
            parts.append(f"{count} {one if count == 1 else many} ({'; '.join(these)})")
    whole = (
        f"of the paper's {len(theirs)} claims " if len(theirs) > 1 else "of the paper's one claim "
    )
    text = f"In plain words: {where}{whole}{_listed(parts)}."
    follows = [
        claim.means.replace("{here}", ours.why.partition(" ")[0])
        for claim, _, ours in verdicts
        if claim.means and ours.word == "holds"
    ]
    return " ".join([text, *follows])


def _listed(parts: Sequence[str]) -> str:
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])}, and {parts[-1]}"
