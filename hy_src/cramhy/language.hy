"The plan language in Hy.

A `.hy` file that begins with

    (require cramhy *)
    (in-package :tut)

is line for line Common Lisp after that: `in-package` takes the reader over, so symbols are upcased and live in packages, `#'f`
is a function and `(a . b)` a pair. Each form is compiled by the one compiler of `cramhy_runtime.languages.commonlisp`, and Hy makes Python of
what it emits. `(in-hy)` leads back. Without `in-package` the operators of the plan language take Hy bodies:
`(top-level (par (left) (right)))`; see `plan_macros`."

(eval-and-compile
  (import cramhy_runtime [kernel])
  (import cramhy_runtime.session.boot [boot booted])
  (import cramhy_runtime.session.time-setting [decide])
  (import cramhy_runtime.repl.session [Session])
  (if (or (kernel.active) (booted))
    (boot)
    (Session :time (decide) :lisp False))  ; `hy FILE` begins a session, as `cramhy run FILE` does
  (import cramhy-runtime.languages.hy.files [lisp-form compile-form take-over]))

(import sys
        hy.reader [HyReader])

(defn attend-prompt [[modules None]]
  "Let plans go on while a prompt of Hy waits for a line, and their errors not end it: the prompt whose text is read now, if there is one.
  modules: where it may be; by default anywhere."
  (setv reader (HyReader.current-reader :create False))
  (for [module (or modules (list (.values sys.modules)))]
    (setv repl (.get (getattr module "__dict__" {}) "_hy_repl"))
    (when (and repl reader (is repl.compile.compiler.reader reader))
      (hy.I.cramhy_runtime/repl/hy_prompt.attend repl))))

(attend-prompt)

(defn _at-prompt [compiler]
  "Whether the module that is compiled has a prompt of Hy."
  (in "_hy_repl" (vars compiler.module)))

(defn _typed [compiler goes-on]
  "The model that answers a Lisp form which was typed at a prompt or piped into `hy`; None in a file, which needs no prompt."
  (when (or (_at-prompt compiler) (= compiler.filename "<stdin>"))
    (hy.I.cramhy_runtime/repl/hy_prompt.typed compiler goes-on)))

(defmacro defpackage [_hy-compiler #* parts]
  "As in Common Lisp; a file that defines a package needs no `in-package` before it."
  (or (_typed _hy-compiler False)
      (compile-form (lisp-form "DEFPACKAGE" parts))))

(defn _load-system [compiler operator arguments]
  (or (_typed compiler False)
      (compile-form (lisp-form "EVAL-WHEN" ['(:compile-toplevel :load-toplevel :execute) `(~operator ~@arguments)]))))

(defmacro ros-load:load-system [_hy-compiler #* arguments]
  "As in Common Lisp. In a file the system is there for the forms that follow, such as `in-package`."
  (_load-system _hy-compiler 'ros-load:load-system arguments))

(defmacro asdf:load-system [_hy-compiler #* arguments]
  "As in Common Lisp; see `ros-load:load-system`."
  (_load-system _hy-compiler 'asdf:load-system arguments))

(defmacro in-package [_hy-compiler name]
  "Go on in Common Lisp, in the package `name`; `(in-hy)` leads back. In a file the forms that follow are compiled; at a prompt, and in a
  text that is piped into `hy`, each form that follows is answered."
  (or (_typed _hy-compiler True)
      (do
        (take-over)
        (setv form `(do
                      ~(compile-form (lisp-form "IN-PACKAGE" [name]))
                      (hy.I.cramhy_runtime/languages/hy/lisp_modules.show-package __name__)))
        (if (_at-prompt _hy-compiler)
          `(do (hy.I.cramhy_runtime/repl/hy_prompt.go-on-in-lisp _hy_repl) ~form)
          form))))

(defmacro in-hy [_hy-compiler]
  "Go on in Hy; the way back from `in-package`."
  (when (_at-prompt _hy-compiler)
    '(hy.I.cramhy_runtime/repl/hy_prompt.go-on-in-hy _hy_repl)))

(defmacro lisp-form-read [form]
  "What the reader that `in-package` installed makes of every form after it."
  (compile-form form.value))
