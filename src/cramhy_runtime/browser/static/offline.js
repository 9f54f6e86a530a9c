// The service worker: keeps all files of the site in the browser, so that it opens without a network, and fast. `cramhy browser` writes the
// list. A file whose fingerprint has not changed is not fetched again when the site has. Files that the site has packed are kept unpacked, under
// their own names: Chromium keeps the machine code of WebAssembly for an answer that is the file itself.

const FILES = {};
const NAME = "cramhy-";
const CACHE = NAME + Object.entries(FILES).join().split("").reduce((sum, each) => (Math.imul(sum, 31) + each.charCodeAt(0)) >>> 0, 7);

const PACKED = ".gz";
const TYPES = { wasm: "application/wasm", zip: "application/zip" };
const address = (path) => new URL(path, self.registration.scope).href;

const unpackedName = (path) => (path.endsWith(PACKED) ? path.slice(0, -PACKED.length) : path);

async function filled() {
  const cache = await caches.open(CACHE);
  const older = (await caches.keys()).filter((name) => name.startsWith(NAME) && name !== CACHE);
  for (const [path, fingerprint] of Object.entries(FILES)) {
    const packed = path.endsWith(PACKED);
    const kept = `${address(unpackedName(path))}?${fingerprint}`;
    let answer = null;
    for (const name of older) answer ??= (await (await caches.open(name)).match(kept)) ?? null;
    answer ??= await fetch(address(path), { cache: "no-cache" });
    if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
    await cache.put(kept, packed && answer.url.endsWith(PACKED) ? await unpacked(path, answer) : answer);
  }
}

// The file itself. A host may have said that gzip is its encoding; then the browser has unpacked it, and it begins otherwise.
async function unpacked(path, answer) {
  const blob = await answer.blob();
  const [first, second] = new Uint8Array(await blob.slice(0, 2).arrayBuffer());
  const body = first === 0x1f && second === 0x8b ? blob.stream().pipeThrough(new DecompressionStream("gzip")) : blob;
  return new Response(body, { headers: { "Content-Type": TYPES[path.split(".").at(-2)] ?? "application/octet-stream" } });
}

self.addEventListener("install", (event) => event.waitUntil(filled().then(() => self.skipWaiting())));

self.addEventListener("activate", (event) =>
  event.waitUntil(
    caches
      .keys()
      .then((names) => Promise.all(names.filter((name) => name.startsWith(NAME) && name !== CACHE).map((name) => caches.delete(name))))
      .then(() => self.clients.claim()),
  ),
);

self.addEventListener("fetch", (event) => {
  const url = new URL(event.request.url);
  const scope = self.registration.scope;
  if (event.request.method !== "GET" || !url.href.startsWith(scope)) return;
  const path = url.origin + url.pathname === scope ? "index.html" : (url.origin + url.pathname).slice(scope.length);
  const fingerprint = FILES[path] ?? FILES[path + PACKED];
  if (!fingerprint) return;
  // A page that does not know yet that it has a service worker asks for the packed file. It unpacks what is packed.
  event.respondWith(
    caches
      .open(CACHE)
      .then((cache) => cache.match(`${address(unpackedName(path))}?${fingerprint}`))
      .then((found) => found ?? fetch(event.request)),
  );
});
