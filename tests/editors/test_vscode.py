"""The extension for VS Code: what it declares is what there is, and its preview is a picture."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "dqpaint/editors/vscode"
MANIFEST = json.loads((FOLDER / "package.json").read_text("utf-8"))
CODE = (FOLDER / "extension.js").read_text("utf-8")
NODE = shutil.which("node")


def test_what_is_declared_is_there():
    contributed = MANIFEST["contributes"]
    declared = {one["command"] for one in contributed["commands"]}
    assert declared == set(re.findall(r'registerCommand\("([\w.]+)"', CODE))
    properties = contributed["configuration"]["properties"]
    assert {f"dqpaint.{name}" for name in re.findall(r'setting\("([\w.]+)"', CODE)} == set(
        properties
    )
    # a folder that is opened cannot choose the program that is run
    assert all(one["scope"] == "machine" for one in properties.values())
    from dqpaint.editors import textmate

    (grammar,) = contributed["grammars"]
    assert grammar["scopeName"] == textmate.grammar()["scopeName"]
    assert grammar["path"].removeprefix("./") in MANIFEST["scripts"]["build"]
    (language,) = contributed["languages"]
    rules = json.loads((FOLDER / language["configuration"]).read_text("utf-8"))
    from dqpaint.language.vocabulary import STATEMENTS

    blocks = {word for word, one in STATEMENTS.items() if one.block}
    begins = rules["indentationRules"]["increaseIndentPattern"]
    assert blocks == set(re.search(r"\(([\w|]+)\)", begins)[1].split("|"))


def test_nothing_of_others_lies_here():
    names = {path.name for path in FOLDER.rglob("*")}
    assert not names & {"node_modules", "package-lock.json", "yarn.lock", "pnpm-lock.yaml", "dist"}


# Stands for the editor: what it is told to do is written down, the program is run in earnest.
HARNESS = """
const Module = require("node:module");
const [extension, file, python] = process.argv.slice(1);
const commands = {}, panel = { webview: {}, onDidDispose() {} };
const configured = { path: python, "preview.options": ["--size", "64x36"] };
const vscode = {
  ViewColumn: { Beside: 2 },
  commands: { registerCommand: (name, run) => ((commands[name] = run), {}) },
  window: {
    activeTextEditor: { document: { languageId: "traj", fileName: file } },
    createWebviewPanel: (kind, title, where, options) => ((panel.options = options), panel),
    showErrorMessage: (text) => console.error(text),
  },
  workspace: {
    getConfiguration: () => ({ get: (name) => configured[name] }),
    onDidSaveTextDocument: () => ({}),
  },
};
let started;
class LanguageClient {
  constructor(id, name, run, options) { started = { run, options }; }
  async start() {}
  async stop() {}
}
const load = Module._load;
Module._load = (name, ...rest) =>
  name === "vscode" ? vscode
  : name === "vscode-languageclient/node" ? { LanguageClient } : load(name, ...rest);
const mine = require(extension);
mine.activate({ subscriptions: [] }).then(() => {
  commands["dqpaint.preview"]();
  const wait = setInterval(() => {
    if (panel.webview.html) {
      clearInterval(wait);
      console.log(JSON.stringify({ html: panel.webview.html, options: panel.options, started }));
    }
  }, 50);
});
"""


@pytest.mark.slow
@pytest.mark.skipif(NODE is None, reason="node is not installed")
@pytest.mark.parametrize(
    ("text", "shows"), [("line to (30, 10) mm\n", "image/png"), ("lin <b>\n", "E120")]
)
def test_the_preview_is_shown_beside(text, shows, tmp_path):
    (tmp_path / "a.traj").write_text(text)
    program = tmp_path / "dqpaint"
    program.write_text(f'#!/bin/sh\nPYTHONPATH={ROOT} exec {sys.executable} -m dqpaint "$@"\n')
    program.chmod(0o755)
    done = subprocess.run(
        [NODE, "-e", HARNESS, str(FOLDER / "extension.js"), str(tmp_path / "a.traj"), str(program)],
        capture_output=True, text=True, timeout=120, check=True,
    )  # fmt: skip
    seen = json.loads(done.stdout)
    assert shows in seen["html"]
    assert "<b>" not in seen["html"]
    assert seen["options"]["enableScripts"] is False
    assert seen["started"]["run"]["args"] == ["lsp"]
    assert not [path for path in tmp_path.iterdir() if path.suffix == ".png"]
