// node run_pytest.mjs '{"pyodide": FOLDER, "folders": {PLACE: FOLDER}, "environment": {}, "path": [PLACE], "arguments": [TEXT]}'
//
// Runs pytest in Pyodide: the folders of this machine are at their places there, the environment and the import path are as given.

const { pyodide, folders, environment, path, arguments: words } = JSON.parse(process.argv[2]);
const { loadPyodide } = await import(`${pyodide}/pyodide.mjs`);
const { host } = await import(`${folders["/cramhy"]}/src/cramhy_runtime/kernel/backends/stacks.mjs`);

// Node would print the line of the error first, and all of Pyodide is one line.
process.on("uncaughtException", (problem) => {
  console.error(String(problem?.message ?? problem).slice(0, 5000), String(problem?.stack).slice(0, 2000));
  process.exit(70);
});

const python = await loadPyodide({ env: { HOME: "/home/pyodide", ...environment } });
python.registerJsModule("cramhy_host", { host });
for (const [place, folder] of Object.entries(folders)) python.mountNodeFS(place, folder);
const main = python.runPython(`
import os, sys

def main(path, words):
    sys.path[:0] = path
    os.chdir("/cramhy")
    sys.dont_write_bytecode = False
    import pytest
    return int(pytest.main(words))

main
`);
const status = await main.callPromising(python.toPy(path), python.toPy(words));
process.exit(status);
