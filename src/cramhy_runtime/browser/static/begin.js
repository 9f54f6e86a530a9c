// Starts Python before the page's modules are there: they take half a second, which Python can use. `tab.js` takes it over. It is no module,
// since a module waits until the page has been read.

(function () {
  if (typeof WebAssembly !== "object" || typeof WebAssembly.Suspending !== "function") return;
  globalThis.newPython = function () {
    var kept = navigator.serviceWorker && navigator.serviceWorker.controller ? "#kept" : ""; // see unpacking.mjs
    return new Worker("worker.mjs" + location.search + kept, { type: "module" });
  };
  globalThis.firstPython = newPython();
  firstPython.onerror = function () {
    globalThis.firstPython = null; // tab.js makes another one, and tells what is wrong with it
  };
})();
