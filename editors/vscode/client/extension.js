"use strict";
/** The extension: starts `cramhy lsp`, and has a prompt in a terminal, forms that run there, and the turtle's page beside the editor. */

const fs = require("fs");
const path = require("path");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const forms = require("./forms");
const programs = require("./programs");
const { View } = require("./view");

const LANGUAGES = ["commonlisp", "hy"];
let client, terminal, view;

/** The program `cramhy`, as the settings, the folder and the PATH say. */
function program() {
  const folders = (vscode.workspace.workspaceFolders || []).map((each) => each.uri.fsPath);
  return programs.find(vscode.workspace.getConfiguration("cramhy").get("command"), folders, process.platform, fs.existsSync);
}

async function startServer() {
  const command = program();
  client = new LanguageClient(
    "cramhy",
    "cramhy",
    { command, args: ["lsp"] },
    {
      documentSelector: [
        ...LANGUAGES.map((language) => ({ scheme: "file", language })),
        ...LANGUAGES.map((language) => ({ scheme: "untitled", language })),
        { scheme: "file", pattern: "**/package.xml" },
      ],
      middleware: { executeCommand: saveFirst },
    }
  );
  try {
    await client.start();
  } catch (problem) {
    const install = "pip install 'cramhy[lsp]'";
    vscode.window.showErrorMessage(`cramhy: ${command} lsp does not start (${problem.message}). Install it: ${install}. Or set cramhy.command.`);
  }
}

/** What runs is what is on the disk, so the text is saved before its plan or test runs. */
async function saveFirst(command, args, next) {
  const document = vscode.workspace.textDocuments.find((each) => each.uri.toString() === String((args || [])[0]));
  if (document && document.isDirty) await document.save();
  return next(command, args);
}

/** The terminal with the prompt; a new one if there is none, or it has ended. */
function prompt(withView) {
  if (terminal && terminal.exitStatus === undefined && !withView) return terminal;
  if (terminal) terminal.dispose();
  const time = vscode.workspace.getConfiguration("cramhy").get("time");
  const args = ["repl", "--time", time, ...(withView ? ["--view"] : [])];
  terminal = vscode.window.createTerminal({
    name: "cramhy",
    shellPath: program(),
    shellArgs: args,
    env: withView ? view.environment() : {},
  });
  return terminal;
}

function openPrompt() {
  prompt(false).show();
}

function editor() {
  const active = vscode.window.activeTextEditor;
  return active && LANGUAGES.includes(active.document.languageId) ? active : undefined;
}

/** Send the selection, or the top-level form at the cursor, to the prompt, in its package. */
function runForm() {
  const active = editor();
  if (!active) return;
  const text = active.document.getText();
  const form = active.selection.isEmpty
    ? forms.formAt(text, active.document.offsetAt(active.selection.active))
    : active.document.getText(active.selection);
  if (!form) {
    vscode.window.showWarningMessage("cramhy: No complete form stands at the cursor.");
    return;
  }
  const to = prompt(false);
  to.show(true);
  for (const line of forms.forPrompt(form, forms.packageAt(text, active.document.offsetAt(active.selection.start)))) to.sendText(line, true);
}

async function loadFile() {
  const active = editor();
  if (!active) return;
  await active.document.save();
  const to = prompt(false);
  to.show(true);
  to.sendText(`(cl:load ${forms.literal(active.document.uri.fsPath)})`, true);
}

function showView() {
  view.wait();
  prompt(true).show(true);
}

async function activate(context) {
  view = new View(vscode, context.extensionPath, context.globalStorageUri.fsPath);
  const commands = {
    "cramhy.repl": openPrompt,
    "cramhy.runForm": runForm,
    "cramhy.loadFile": loadFile,
    "cramhy.view": showView,
    "cramhy.interruptPlans": () => vscode.commands.executeCommand("cramhy.interrupt"),
    "cramhy.restartServer": async () => {
      if (client) await client.stop().catch(() => undefined);
      await startServer();
    },
  };
  for (const [name, action] of Object.entries(commands)) context.subscriptions.push(vscode.commands.registerCommand(name, action));
  context.subscriptions.push({ dispose: () => view.dispose() });
  context.subscriptions.push(vscode.window.onDidCloseTerminal((closed) => closed === terminal && (terminal = undefined)));
  await startServer();
  return { program, client: () => client, folder: path.basename(context.extensionPath) };
}

function deactivate() {
  return client ? client.stop() : undefined;
}

module.exports = { activate, deactivate };
