"The plan language in Hy.

A `.hy` file that begins with

    (require cramhy *)
    (in-package :tut)

is line for line Common Lisp after that: `in-package` takes the reader over, so symbols are upcased and live in packages, `#'f`
is a function and `(a . b)` a pair. Each form is compiled by the one compiler of `cramhy_runtime.lisp`, and Hy makes Python of
what it emits. Without `in-package` the operators of the plan language take Hy bodies: `(top-level (par (left) (right)))`; see `plain.hy`."

(eval-and-compile
  (import cramhy_runtime.image [boot])
  (boot)
  (import cramhy.hy-files [lisp-form compile-form take-over]))

(defmacro defpackage [#* parts]
  "As in Common Lisp; a file that defines a package needs no `in-package` before it."
  (compile-form (lisp-form "DEFPACKAGE" parts)))

(defmacro in-package [name]
  "Go on in Common Lisp, in the package `name`."
  (take-over)
  (compile-form (lisp-form "IN-PACKAGE" [name])))

(defmacro lisp-form-read [form]
  "What the reader that `in-package` installed makes of every form after it."
  (compile-form form.value))

(require cramhy.plain *)
