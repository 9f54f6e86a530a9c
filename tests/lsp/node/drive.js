"use strict";
/** Runs the extension's own client code against `cramhy lsp`: node drive.js EXTENSION CRAMHY FILE. Prints what came of it as JSON. */

const fs = require("fs");
const path = require("path");
const Module = require("module");
const fake = require("./vscode");
const [extension, cramhy, file] = process.argv.slice(2);

const load = Module._load;
Module._load = (name, ...more) => (name === "vscode" ? fake.vscode : load(name, ...more));
process.on("unhandledRejection", (problem) => (console.error(problem), process.exit(3)));

const { seen, vscode } = fake;
const until = async (condition) => {
  while (!condition()) await new Promise((done) => setTimeout(done, 50));
};

async function main() {
  seen.settings = { "cramhy.command": cramhy, "cramhy.time": "virtual" };
  const { activate, deactivate } = require(path.join(extension, "client", "extension.js"));
  const context = { subscriptions: [], extensionPath: extension, globalStorageUri: vscode.Uri.file(path.join(path.dirname(file), "storage")) };
  await activate(context);
  const text = fs.readFileSync(file, "utf8");
  const document = new fake.Document(vscode.Uri.file(file), "hy", text);
  vscode.workspace.textDocuments.push(document);
  fake.opened.fire(document);
  await until(() => (seen.diagnostics.get(String(document.uri)) || []).length);
  const place = text.slice(0, text.indexOf("(defun perform-draw-house")).split("\n").length - 1;
  vscode.window.activeTextEditor = { document, selection: new fake.Selection(place, 3, place, 3) };
  vscode.window.activeTextEditor.document.getText = (range) => (range ? "" : text);
  await vscode.commands.executeCommand("cramhy.runForm");
  await vscode.commands.executeCommand("cramhy.loadFile");
  const ran = await vscode.commands.executeCommand("cramhy.run", String(document.uri), "perform-draw-house");
  const interrupted = await vscode.commands.executeCommand("cramhy.interruptPlans");
  await vscode.commands.executeCommand("cramhy.view");
  const told = seen.diagnostics.get(String(document.uri)).map((each) => [each.range.start.line, each.severity, each.message]);
  const result = {
    commands: [...seen.commands.keys()].sort(),
    told,
    providers: Object.keys(seen.providers).sort(),
    terminals: seen.terminals.map((each) => [each.options.shellArgs, Object.keys(each.options.env), each.sent]),
    ran,
    interrupted,
    messages: seen.messages,
  };
  for (const each of context.subscriptions) each.dispose();
  await deactivate();
  console.log(JSON.stringify(result));
  process.exit(0);
}

main();
