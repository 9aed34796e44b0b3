// Starts `dqpaint lsp` and shows `dqpaint preview` beside the text. All that is known of the
// language is in the server; nothing here needs a change when the language has a new word.

const { execFile } = require("node:child_process");
const path = require("node:path");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

const LARGEST_PICTURE = 64 * 1024 * 1024; // bytes
let client;
let panel;
let shown; // the document in the panel
let running; // the process that makes its picture

const setting = (name) => vscode.workspace.getConfiguration("dqpaint").get(name);

async function startServer() {
  const run = { command: setting("path"), args: ["lsp"] };
  client = new LanguageClient("dqpaint", "dqpaint", run, {
    documentSelector: [{ language: "traj" }],
  });
  try {
    await client.start();
  } catch (fault) {
    vscode.window.showErrorMessage(
      `dqpaint lsp does not start: ${fault.message}. It needs: pip install 'dqpaint[lsp]'; ` +
        "the setting dqpaint.path names the program.",
    );
  }
}

function openPreview() {
  const editor = vscode.window.activeTextEditor;
  if (!editor || editor.document.languageId !== "traj") {
    return;
  }
  shown = editor.document;
  if (!panel) {
    panel = vscode.window.createWebviewPanel(
      "dqpaint.preview",
      "Preview",
      { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true },
      { enableScripts: false, localResourceRoots: [] },
    );
    panel.onDidDispose(() => {
      panel = undefined;
      running?.kill();
    });
  }
  refresh();
}

function refresh() {
  if (!panel || !shown) {
    return;
  }
  running?.kill();
  panel.title = `Preview of ${path.basename(shown.fileName)}`;
  const words = ["preview", shown.fileName, "--out", "-", ...setting("preview.options")];
  const options = { cwd: path.dirname(shown.fileName), encoding: "buffer", maxBuffer: LARGEST_PICTURE };
  const mine = execFile(setting("path"), words, options, (fault, picture, said) => {
    if (mine !== running || !panel) {
      return; // a newer one is under way
    }
    panel.webview.html = page(fault ? undefined : picture, said.toString() || fault?.message || "");
  });
  running = mine;
}

function page(picture, text) {
  const image = picture
    ? `<img style="max-width:100%" src="data:image/png;base64,${picture.toString("base64")}">`
    : "";
  const escaped = text.replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);
  const policy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";
  return `<!doctype html><html><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}"></head>
<body>${image}<pre style="white-space:pre-wrap">${escaped}</pre></body></html>`;
}

exports.activate = async (context) => {
  context.subscriptions.push(
    vscode.commands.registerCommand("dqpaint.preview", openPreview),
    vscode.commands.registerCommand("dqpaint.restart", async () => {
      await client?.stop();
      await startServer();
    }),
    vscode.workspace.onDidSaveTextDocument((document) => {
      if (document.languageId === "traj") {
        refresh(); // also for a drawing that the shown one includes
      }
    }),
  );
  await startServer();
};

exports.deactivate = () => {
  running?.kill();
  return client?.stop();
};
