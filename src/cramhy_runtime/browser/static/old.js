// Tells the users of a browser that cannot run plans which ones can. It is no module, and in the JavaScript of 2009, so that every browser
// reads it.

(function () {
  if (typeof WebAssembly === "object" && typeof WebAssembly.Suspending === "function") return;
  document.getElementById("unfit").removeAttribute("hidden");
  document.body.setAttribute("data-prompt", "unfit");
})();
