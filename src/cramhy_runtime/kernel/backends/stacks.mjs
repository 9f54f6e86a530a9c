// The half of the back end "jspi" that only JavaScript can do: stacks, promises, and turns of the event loop. The other half is jspi.py.
//
// Whoever starts Python gives it this: `python.registerJsModule("cramhy_host", { host })`. Python reads attributes of a module once, so
// all names stand in the object `host`. Promises are attributes and not results of methods: Pyodide wraps what a method returns.

const BREATH = 25; // ms that Python may compute before the event loop, and so a message or Ctrl-C, gets a turn

// Stacks at a time. In V8 each takes 24 KiB, and Python ends without a message somewhere below 20,000 (measured in Node 26). In Firefox 153 a
// stack takes 1 MiB of addresses, and each collection of JavaScript's garbage walks all of them: 3,000 tasks take 9 s, 8,000 more than a
// minute. An engine that was not measured gets the smaller figure.
const most = /\b(Chrome|Node\.js)\//.test(globalThis.navigator?.userAgent) ? 8000 : 2000;

let heard = performance.now(); // when the event loop had its last turn

// A turn of the event loop. setTimeout would take 4 ms in a browser, and microtasks alone let no message in.
const tick = (() => {
  const promise = (begin) =>
    new Promise((resolve) =>
      begin(() => {
        heard = performance.now();
        resolve();
      }),
    );
  if (globalThis.setImmediate) return () => promise(setImmediate);
  const { port1, port2 } = new MessageChannel();
  const waiting = [];
  port1.onmessage = () => waiting.shift()();
  return () =>
    promise((go) => {
      waiting.push(go);
      port2.postMessage(null);
    });
})();

const due = () => performance.now() - heard > BREATH;

// What a suspended stack waits for: the baton. It is given at most once for each time that `turn` was read.
class Turn {
  #resolve = null;

  get turn() {
    return new Promise((resolve) => {
      this.#resolve = resolve;
    });
  }

  give() {
    const resolve = this.#resolve;
    this.#resolve = null;
    if (due()) tick().then(resolve);
    else resolve();
  }
}

// Wakes the stack that waits while every task is parked. A ring that nobody waits for is kept; two of them are one.
class Bell {
  #rang = false;
  #wake = null;
  milliseconds = 0; // how long `rings` waits at most

  ring() {
    if (this.#wake) this.#wake();
    else this.#rang = true;
  }

  get rings() {
    if (this.#rang) {
      this.#rang = false;
      return tick();
    }
    return new Promise((resolve) => {
      const wake = () => {
        clearTimeout(timer);
        this.#wake = null;
        heard = performance.now();
        resolve();
      };
      const timer = setTimeout(wake, this.milliseconds);
      this.#wake = wake;
    });
  }
}

// Call a function of Python's on a stack of its own as soon as the present one is suspended, so that no stack stands on another.
function launch(life) {
  const kept = life.copy();
  queueMicrotask(() =>
    kept
      .callPromising()
      .catch((problem) => console.error("A stack of cramhy broke off:", problem))
      .finally(() => kept.destroy()),
  );
}

export const host = {
  Turn,
  Bell,
  launch,
  due,
  most,
  get tick() {
    return tick();
  },
};
