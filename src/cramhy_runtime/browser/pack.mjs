// node pack.mjs PYODIDE STACKS SOURCE TARGET LIBRARY: packing.py, run in Pyodide. SOURCE is a tar file of packages. TARGET becomes what a tab
// unpacks, packed by Zstandard: the packages and what they need of Python's library. LIBRARY becomes a zip file with what Python needs to begin.

import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { constants, zstdCompressSync } from "node:zlib";

const [pyodide, stacks, source, target, library] = process.argv.slice(2);
const { loadPyodide } = await import(pathToFileURL(`${pyodide}/pyodide.mjs`));
const { host } = await import(pathToFileURL(stacks));

const HOME = "/home/pyodide";
const python = await loadPyodide({ env: { HOME, PYTHONHASHSEED: "0" } });
python.registerJsModule("cramhy_host", { host });
python.FS.writeFile("/tmp/source.tar", readFileSync(source));
const main = python.runPython(`
import os, pathlib, sys
import compression.zstd  # by which the tab unpacks
LIBRARY = pathlib.Path("/lib/python3.14")
FOLDER = LIBRARY / "site-packages"
os.environ["ROS_PACKAGE_PATH"] = str(FOLDER / "cramhy_runtime" / "tutorials")
loaded = set(sys.modules)

def main():
    import tarfile
    with tarfile.open("/tmp/source.tar") as source:
        source.extractall(FOLDER, filter="fully_trusted")
        packages = sorted({name.partition("/")[0] for name in source.getnames()})
    from cramhy_runtime.browser import packing
    library = packing.Library("/lib/python314.zip", loaded)
    packing.compile_all(FOLDER, packages)
    return packing.packed(FOLDER, packages, library.rest()), library.boot()

main
`);
const [packed, boot] = await main.callPromising().catch((problem) => {
  console.error(problem.message); // without the line of Pyodide's own, of a megabyte
  process.exit(1);
});
const params = { [constants.ZSTD_c_compressionLevel]: 22, [constants.ZSTD_c_windowLog]: 25 };
writeFileSync(target, zstdCompressSync(packed.toJs(), { params }));
writeFileSync(library, boot.toJs());
process.exit(0);
