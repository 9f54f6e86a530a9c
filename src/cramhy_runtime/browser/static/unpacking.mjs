// The large files of the site, which are packed. Not every static host packs what it sends, so the site is packed by itself. The service
// worker has them unpacked.

const PACKED = /\/pyodide\/[^/]+\.(wasm|zip)$/; // what Pyodide fetches under its own name, and the site has as .gz
const KEPT = "#kept"; // behind the worker's address: the page has a service worker
const LIBRARY = "/lib/python3.14";
const TIME = 1_000_000_000_000; // ms since 1970, of every file, as in packing.py
const plain = globalThis.fetch;

async function fetched(path) {
  const answer = await plain(path);
  if (!answer.ok) throw new Error(`${path} cannot be fetched (${answer.status})`);
  return answer;
}

// The content of a file packed by gzip, as the body of a response. A host may have said that gzip is its encoding; then the browser has
// unpacked it, and the file begins otherwise.
async function unzipped(path) {
  const blob = await (await fetched(path)).blob();
  const [first, second] = new Uint8Array(await blob.slice(0, 2).arrayBuffer());
  return first === 0x1f && second === 0x8b ? blob.stream().pipeThrough(new DecompressionStream("gzip")) : blob;
}

globalThis.fetch = async (address, ...rest) => {
  if (!PACKED.test(address)) return plain(address, ...rest);
  if (location.hash === KEPT) {
    const answer = await plain(address, ...rest);
    if (answer.ok) return answer;
  }
  return new Response(await unzipped(`${address}.gz`), { headers: { "Content-Type": "application/wasm" } });
};

// Fetches the packages while Python is made ready. The result is a function that puts them where Python, given to it, finds them.
// What the file holds: see packing.py.
export function packages(path) {
  const archive = fetched(path).then((answer) => answer.arrayBuffer());
  return async (python) => {
    const unpack = python.runPython("import compression.zstd; lambda data: compression.zstd.decompress(data.to_memoryview())");
    const unpacked = unpack(new Uint8Array(await archive));
    const view = unpacked.getBuffer("u8");
    write(python.FS, view.data.slice());
    view.release();
    unpacked.destroy();
    unpack.destroy();
    python.runPython(`
import sys
sys.path_importer_cache.clear()  # the folders were empty
sys.path.insert(sys.path.index("${LIBRARY}/lib-dynload"), "${LIBRARY}")
`);
  };
}

function write(FS, bytes) {
  const start = 4 + new DataView(bytes.buffer).getUint32(0);
  const folders = new Set();
  let place = start;
  for (const [name, size] of JSON.parse(new TextDecoder().decode(bytes.subarray(4, start)))) {
    const path = `${LIBRARY}/${name}`;
    const folder = path.slice(0, path.lastIndexOf("/"));
    if (!folders.has(folder)) FS.mkdirTree(folder);
    folders.add(folder);
    FS.writeFile(path, bytes.subarray(place, (place += size)), { canOwn: true });
    FS.utime(path, TIME, TIME); // compiled Lisp is stamped with the times of its sources
  }
}
