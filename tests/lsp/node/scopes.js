"use strict";
/** Prints the scopes of each token of a text, as VS Code's own library for grammars finds them: node scopes.js EXTENSION SCOPE FILE. */

const fs = require("fs");
const path = require("path");
const [extension, scope, file] = process.argv.slice(2);
const load = (name) => require(require.resolve(name, { paths: [extension] }));
const { Registry, INITIAL, parseRawGrammar } = load("vscode-textmate");
const oniguruma = load("vscode-oniguruma");

async function main() {
  const wasm = require.resolve("vscode-oniguruma/release/onig.wasm", { paths: [extension] });
  await oniguruma.loadWASM(fs.readFileSync(wasm).buffer);
  const grammars = JSON.parse(fs.readFileSync(path.join(extension, "package.json"), "utf8")).contributes.grammars;
  const registry = new Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async (name) => {
      const found = grammars.find((each) => each.scopeName === name);
      return found ? parseRawGrammar(fs.readFileSync(path.join(extension, found.path), "utf8"), found.path) : null;
    },
  });
  const grammar = await registry.loadGrammar(scope);
  let stack = INITIAL;
  const told = [];
  for (const line of fs.readFileSync(file, "utf8").split("\n")) {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, stack);
    told.push(tokens.map((each) => [line.slice(each.startIndex, each.endIndex), each.scopes.slice(1).join(" ")]));
    stack = ruleStack;
  }
  console.log(JSON.stringify(told));
}

main();
