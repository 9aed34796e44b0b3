"""README.md and an address of the sources -> the page of the package, when it is built.

Links of README are relative, which works where the sources lie and nowhere else. With an address in
`[tool.hatch.metadata.hooks.custom]` they become absolute and the package has its URLs; without one
pictures give way to what they show and links to their words, so that nothing on it is broken.
"""

import re
from pathlib import Path

from hatchling.metadata.plugin.interface import MetadataHookInterface

PICTURE = re.compile(r"!\[([^\]]*)\]\((?!https?:)([^)\s]+)\)")
LINK = re.compile(r"\[((?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*)\]\((?!https?:)([^)\s]+)\)")
URLS = {"Source": "", "Documentation": "/blob/main/docs", "Changelog": "/blob/main/CHANGELOG.md"}


def page(readme: str, source: str) -> str:
    """The text of the package's page.

    Args:
        readme: in Markdown, its links relative.
        source: address of the repository; empty where there is none yet.
    """
    if not source:
        return LINK.sub(r"\1", PICTURE.sub(r"*\1*", readme))
    pictures = PICTURE.sub(rf"![\1]({source}/raw/main/\2)", readme)
    return LINK.sub(lambda found: f"[{found[1]}]({_absolute(found[2], source)})", pictures)


def _absolute(link: str, source: str) -> str:
    return link if link.startswith("#") else f"{source}/blob/main/{link}"


def urls(source: str) -> dict[str, str]:
    """The addresses of the package; none where there is no source yet."""
    return {name: source + rest for name, rest in URLS.items()} if source else {}


class PackagePage(MetadataHookInterface):
    """Gives the metadata what depends on the address of the sources."""

    def update(self, metadata: dict) -> None:
        """Set the page and the addresses."""
        source = self.config.get("source", "").rstrip("/")
        text = page(Path(self.root, "README.md").read_text("utf-8"), source)
        metadata["readme"] = {"content-type": "text/markdown", "text": text}
        metadata["urls"] = urls(source)
