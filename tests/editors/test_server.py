"""The language server, spoken to by an editor: a real process, the protocol on its pipes."""

import json
import os
import queue
import subprocess
import sys
import threading

import pytest

pytestmark = pytest.mark.slow
URI = "file:///tmp/wish.traj"
GOOD = "period 8 ms\nstart at (0, 0) mm\nline to (100, 0) mm in 2 s light red\n"


class Editor:
    """Sends requests, and sorts what comes back."""

    def __init__(self, encodings):
        self._process = subprocess.Popen(
            [sys.executable, "-m", "dqpaint", "lsp"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            env={**os.environ, "PYTHONWARNINGS": "error"},
        )  # fmt: skip
        self._inbox = queue.Queue()
        threading.Thread(target=self._listen, daemon=True).start()
        self._id = 0
        capabilities = {"general": {"positionEncodings": encodings}} if encodings else {}
        self.abilities = self.ask("initialize", processId=None, rootUri=None,
                                  capabilities=capabilities)["capabilities"]  # fmt: skip
        self.tell("initialized")

    def _listen(self):
        pipe = self._process.stdout
        while header := pipe.readline():
            size = int(header.split(b":")[1])
            while pipe.readline().strip():
                pass
            self._inbox.put(json.loads(pipe.read(size)))

    def _send(self, **message):
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self._process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(data), data))
        self._process.stdin.flush()

    def send_bytes(self, data):
        self._process.stdin.write(data)
        self._process.stdin.flush()

    def answer(self):
        """The next answer to a request, of whatever kind."""
        while True:
            message = self._inbox.get(timeout=30)
            if "id" in message:
                return message

    def tell(self, method, **params):
        self._send(method=method, params=params)

    def ask(self, method, **params):
        self._id += 1
        self._send(id=self._id, method=method, params=params)
        while True:
            message = self._inbox.get(timeout=30)
            if message.get("id") == self._id:
                assert "error" not in message, message
                return message["result"]

    def messages(self):
        """What is wrong, as it is told next."""
        while True:
            message = self._inbox.get(timeout=30)
            if message.get("method") == "textDocument/publishDiagnostics":
                return message["params"]["diagnostics"]

    def open(self, text, uri=URI):
        item = {"uri": uri, "languageId": "traj", "version": 1, "text": text}
        self.tell("textDocument/didOpen", textDocument=item)
        return self.messages()

    def change(self, text, version):
        self.tell("textDocument/didChange", textDocument={"uri": URI, "version": version},
                  contentChanges=[{"text": text}])  # fmt: skip
        return self.messages()

    def at(self, method, line, character, **more):
        return self.ask(method, textDocument={"uri": URI},
                        position={"line": line, "character": character}, **more)  # fmt: skip

    def fixes(self, where):
        return self.ask("textDocument/codeAction", textDocument={"uri": URI}, range=where,
                        context={"diagnostics": []})  # fmt: skip

    def leave(self):
        self.ask("shutdown")
        self.tell("exit")
        code = self._process.wait(timeout=20)
        err = self._process.stderr.read().decode()
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            pipe.close()
        return code, err


@pytest.fixture
def editor(request):
    editor = Editor(getattr(request, "param", None))
    yield editor
    code, err = editor.leave()
    assert code == 0, err
    assert "Traceback" not in err


def span(where):
    return tuple((where[end]["line"], where[end]["character"]) for end in ("start", "end"))


def test_messages_come_and_go(editor):
    assert editor.abilities["hoverProvider"]
    (found,) = editor.open("lin to (100, 0) mm\nline to (1, 0) mm\n")
    assert (found["code"], found["source"], found["severity"]) == ("E120", "dqpaint", 1)
    assert found["message"] == "unknown statement 'lin'\nhelp: did you mean 'line'?"
    assert span(found["range"]) == ((0, 0), (0, 3))
    assert editor.change(GOOD, 2) == []
    (found,) = editor.change(GOOD + "line by (0, 0) mm\n", 3)
    assert (found["code"], found["severity"]) == ("W401", 2)
    editor.tell("textDocument/didClose", textDocument={"uri": URI})
    assert editor.messages() == []


def test_times_are_looked_at_when_a_text_is_opened_and_saved(editor):
    slow = "line to (30, 0) mm speed 0.000001 mm/s\n"
    assert [d["code"] for d in editor.open(slow)] == ["E302"]
    assert editor.change(slow + "# typing\n", 2) == []
    editor.tell("textDocument/didSave", textDocument={"uri": URI})
    assert [d["code"] for d in editor.messages()] == ["E302"]


@pytest.mark.parametrize(
    ("editor", "column"), [(None, 23), (["utf-32"], 21), (["utf-8"], 28)], indirect=["editor"]
)
def test_columns_are_the_editor_s(editor, column):
    """An ö is one unit of UTF-16 and two of UTF-8, an emoji two and four."""
    (found,) = editor.open('period 8 ms\r\nhold 1 s light "ö😀😀" lihgt\r\n')
    assert span(found["range"]) == ((1, column), (1, column + 5))

    def fixes(at):
        return editor.fixes(
            {"start": {"line": 1, "character": at}, "end": {"line": 1, "character": at}}
        )

    (fix,) = fixes(column)
    (edit,) = fix["edit"]["changes"][URI]
    assert (span(edit["range"]), edit["newText"]) == (span(found["range"]), "light")
    assert fixes(column - 1) == []


def test_hover_says_what_a_word_means_and_how_long_the_line_is(editor):
    editor.open(GOOD)
    hover = editor.at("textDocument/hover", 2, 1)
    text = hover["contents"]["value"]
    assert text.startswith("100 mm in 2 s, at most 62.5 mm/s\n\n**line**: a straight stroke")
    assert "- `to (10, 0) mm`: the point to go to" in text
    assert span(hover["range"]) == ((2, 0), (2, 4))
    assert (
        "**mm**: the unit millimetre" in editor.at("textDocument/hover", 2, 17)["contents"]["value"]
    )
    assert editor.at("textDocument/hover", 2, 12) is None


def test_completion_knows_the_place(editor):
    editor.open("let radius_of_it = 3 mm\narc \nlaw \nline to (0, 0) m\n# l\n")

    def words(line, character):
        return {item["label"] for item in editor.at("textDocument/completion", line, character)}

    assert {"line", "arc", "repeat"} <= words(0, 2)
    assert "centre" not in words(0, 2)
    assert {"centre", "via", "radius_of_it", "polar"} <= words(1, 4)
    assert words(2, 4) == {"constant", "trapezoid", "cubic", "quintic", "smooth"}
    assert "mm" in words(3, 15)
    assert words(4, 3) == set()


def test_quick_fixes_mend(editor):
    text = "lin to (100, 0)\nspeed 40 mm\nlight #ff8800\n"
    editor.open(text)
    everywhere = {"start": {"line": 0, "character": 0}, "end": {"line": 9, "character": 0}}
    fixes = editor.fixes(everywhere)
    assert [fix["title"] for fix in fixes] == [
        "write line",
        "write 40 mm/s",
        "put the colour in quotes",
    ]
    assert (
        len(
            editor.fixes({"start": {"line": 1, "character": 7}, "end": {"line": 1, "character": 7}})
        )
        == 1
    )
    lines = text.split("\n")
    for fix in fixes:
        (edit,) = fix["edit"]["changes"][URI]
        (line, first), (_, last) = span(edit["range"])
        lines[line] = lines[line][:first] + edit["newText"] + lines[line][last:]
    assert lines[:3] == ["line to (100, 0)", "speed 40 mm/s", 'light "#ff8800"']
    (found,) = editor.change("\n".join(lines), 2)
    assert found["message"].startswith("'to' needs a length")


def test_layout_is_that_of_fmt(editor):
    editor.open("line   to (1,2)mm")
    (edit,) = editor.ask("textDocument/formatting", textDocument={"uri": URI},
                         options={"tabSize": 2, "insertSpaces": True})  # fmt: skip
    assert edit["newText"] == "line to (1, 2) mm\n"
    editor.change("lin to", 2)
    assert editor.ask("textDocument/formatting", textDocument={"uri": URI},
                      options={"tabSize": 2, "insertSpaces": True}) == []  # fmt: skip


def test_what_another_file_says_wrong_is_told_with_its_place(editor, tmp_path):
    (tmp_path / "b.traj").write_text("\nlet a = 1 mm\nline by (50, 0)\n")
    (found,) = editor.open('include "b.traj"\nlet r = 2 mm\n', (tmp_path / "a.traj").as_uri())
    assert found["code"] == "E218"
    assert span(found["range"]) == ((0, 0), (0, 0))
    assert found["message"].startswith(f"{tmp_path / 'b.traj'}:3:9: ")
    (found,) = editor.open(
        'let a = 2 mm\ninclude "b.traj"\n'.replace("b.traj", "c.traj"),
        (tmp_path / "d.traj").as_uri(),
    )
    assert found["code"] == "E272"
    assert span(found["range"]) == ((1, 8), (1, 16))


def test_old_versions_of_a_text_are_skipped(editor):
    """A key a message: each is taken in, the last is looked at."""
    lines = [f"line by (1, {k % 7 - 3}) mm" for k in range(400)]
    editor.open("\n".join(["period 8 ms", *lines, ""]))
    here = {"line": 200, "character": 0}
    for key in range(100):
        editor.tell(
            "textDocument/didChange", textDocument={"uri": URI, "version": key + 2},
            contentChanges=[{"text": "x", "range": {"start": here, "end": here}}],
        )  # fmt: skip
    told, last = 0, (200, 100 + len("line"))
    while span(editor.messages()[0]["range"]) != ((200, 0), last):
        told += 1
    assert told < 50


@pytest.mark.parametrize(
    ("method", "params"),
    [
        ("textDocument/hover", {}), ("textDocument/hover", [1]), ("textDocument/hover", None),
        ("textDocument/hover", {"textDocument": 3, "position": {"line": "a"}}),
        ("textDocument/completion", {"textDocument": {"uri": URI}}),
        ("textDocument/codeAction", {"textDocument": {"uri": URI}, "range": {}, "context": {}}),
    ],
)  # fmt: skip
def test_malformed_parameters_get_an_error(editor, method, params):
    data = json.dumps({"jsonrpc": "2.0", "id": 77, "method": method, "params": params}).encode()
    editor.send_bytes(b"Content-Length: %d\r\n\r\n%s" % (len(data), data))
    said = editor.answer()
    assert said["id"] == 77
    assert said["error"]["code"] in (-32600, -32602, -32603)
    assert editor.open(GOOD) == []  # it lives


@pytest.mark.parametrize("told", ["1", "20", "99", "99999", "999999999999999999", "-5", "abc", ""])
def test_a_wrong_length_is_survived(editor, told):
    data = json.dumps(
        {"jsonrpc": "2.0", "id": 78, "method": "textDocument/hover", "params": {}}
    ).encode()
    editor.send_bytes(b"Content-Length: %s\r\n\r\n%s" % (told.encode(), data))
    assert editor.open(GOOD) == []


NAMED = """let r = 20 mm
def petal(n)
  line by (r, 0) light red
end
petal(1)
line to polar(r, 30 deg) in 2 s light hsv(120 deg)
"""


def whole(text):
    return {"start": {"line": 0, "character": 0}, "end": {"line": text.count("\n"), "character": 0}}


def places(found):
    return [span(one["range"])[0] for one in found]


def test_names_are_found_defined_and_renamed(editor):
    for ability in ("documentSymbolProvider", "definitionProvider", "referencesProvider",
                    "renameProvider", "foldingRangeProvider", "colorProvider", "inlayHintProvider",
                    "signatureHelpProvider"):  # fmt: skip
        assert editor.abilities[ability], ability
    editor.open(NAMED)
    document = {"uri": URI}
    outline = editor.ask("textDocument/documentSymbol", textDocument=document)
    assert [one["name"] for one in outline] == ["r", "petal"]
    defined = editor.at("textDocument/definition", 5, 14)
    assert span(defined["range"]) == ((0, 4), (0, 5))
    used = editor.at("textDocument/references", 0, 4, context={"includeDeclaration": False})
    assert places(used) == [(2, 11), (5, 14)]
    edits = editor.at("textDocument/rename", 4, 2, newName="leaf")["changes"][URI]
    assert [(places([one])[0], one["newText"]) for one in edits] == [
        ((1, 4), "leaf"), ((4, 0), "leaf")
    ]  # fmt: skip
    folds = editor.ask("textDocument/foldingRange", textDocument=document)
    assert [(one["startLine"], one["endLine"]) for one in folds] == [(1, 3)]


@pytest.mark.parametrize("word", ["line", "r", "2r", "red", "a b", ""])
def test_what_cannot_be_a_name_is_refused(editor, word):
    editor.open(NAMED)
    editor._id += 1
    where = {"textDocument": {"uri": URI}, "position": {"line": 4, "character": 2}}
    editor._send(id=editor._id, method="textDocument/rename", params={**where, "newName": word})
    assert editor.answer()["error"]["message"]


def test_colours_seconds_and_calls(editor):
    editor.open(NAMED)
    document = {"uri": URI}
    found = editor.ask("textDocument/documentColor", textDocument=document)
    assert places(found) == [(2, 23), (5, 38)]
    assert found[1]["color"] == {"red": 0.0, "green": 1.0, "blue": 0.0, "alpha": 1.0}
    picked = editor.ask("textDocument/colorPresentation", textDocument=document,
                        color=found[0]["color"], range=found[0]["range"])  # fmt: skip
    assert [one["label"] for one in picked] == ['"#ff0000"', "red"]
    hints = editor.ask("textDocument/inlayHint", textDocument=document, range=whole(NAMED))
    assert {one["position"]["line"]: one["label"] for one in hints}[5] == "2 s"
    help = editor.at("textDocument/signatureHelp", 5, 17)
    assert help["signatures"][0]["label"] == "polar(RADIUS, ANGLE)"
    assert help["activeParameter"] == 1
    own = editor.at("textDocument/signatureHelp", 4, 6)
    assert own["signatures"][0]["label"] == "petal(n)"


def test_a_name_of_an_included_file_is_found_there(editor, tmp_path):
    (tmp_path / "part.traj").write_text("let r = 5 mm\n")
    main = tmp_path / "main.traj"
    text = 'include "part.traj"\nline by (r, 0)\n'
    main.write_text(text)
    editor.open(text, main.as_uri())
    where = {"textDocument": {"uri": main.as_uri()}}
    found = editor.ask("textDocument/definition", **where, position={"line": 1, "character": 9})
    assert found["uri"] == (tmp_path / "part.traj").as_uri()
    assert span(found["range"]) == ((0, 4), (0, 5))
    file = editor.ask("textDocument/definition", **where, position={"line": 0, "character": 12})
    assert file["uri"] == (tmp_path / "part.traj").as_uri()
