// Starts Python before the page's modules are there: they take half a second, which Python can use. `tab.js` takes it over. It is no module,
// since a module waits until the page has been read.

(function () {
  if (typeof WebAssembly !== "object" || typeof WebAssembly.Suspending !== "function") return;
  var python = (globalThis.firstPython = new Worker("worker.mjs" + location.search, { type: "module" }));
  python.onerror = function () {
    globalThis.firstPython = null; // tab.js makes another one, and tells what is wrong with it
  };
})();
