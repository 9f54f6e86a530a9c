// node pack.mjs PYODIDE STACKS SOURCE TARGET: packing.py, run in Pyodide. SOURCE and TARGET are tar files.

import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [pyodide, stacks, source, target] = process.argv.slice(2);
const { loadPyodide } = await import(pathToFileURL(`${pyodide}/pyodide.mjs`));
const { host } = await import(pathToFileURL(stacks));

const HOME = "/home/pyodide";
const python = await loadPyodide({ env: { HOME, PYTHONHASHSEED: "0" } });
python.registerJsModule("cramhy_host", { host });
python.FS.writeFile("/tmp/source.tar", readFileSync(source));
const main = python.runPython(`
import os, pathlib, sys, tarfile
FOLDER = pathlib.Path("/lib/python3.14/site-packages")
os.environ["ROS_PACKAGE_PATH"] = str(FOLDER / "cramhy_runtime" / "tutorials")

def main():
    with tarfile.open("/tmp/source.tar") as source:
        source.extractall(FOLDER, filter="fully_trusted")
        packages = sorted({name.partition("/")[0] for name in source.getnames()})
    from cramhy_runtime.browser import packing
    packing.compile_all(FOLDER, packages)
    return packing.packed(FOLDER, packages)

main
`);
const packed = await main.callPromising();
writeFileSync(target, packed.toJs());
process.exit(0);
