"""The suite on every Python that is found: `nox`, or `nox -s everyday-3.13`."""

import nox

VERSIONS = ["3.11", "3.12", "3.13", "3.14"]
nox.options.error_on_missing_interpreters = False
nox.options.reuse_existing_virtualenvs = True


def install(session: nox.Session) -> None:
    """What the tests need."""
    session.install("-c", "constraints.txt", "-e", ".[test]")


@nox.session(python=VERSIONS)
def everyday(session: nox.Session) -> None:
    """What is quick."""
    install(session)
    session.run("python", "-m", "pytest", "-n", "logical", "-m", "not slow", *session.posargs)


@nox.session(python=VERSIONS, default=False)
def whole(session: nox.Session) -> None:
    """Everything."""
    install(session)
    session.run("python", "-m", "pytest", "-n", "logical", *session.posargs)
