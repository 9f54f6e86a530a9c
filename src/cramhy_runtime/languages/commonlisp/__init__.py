"""Common Lisp, in one folder for each part of the standard.

It stands on the room ``lisp_core``, which has data, special variables, conditions and equality. These are the parts in their order; each
imports only from those that are named before it:

* `standard_names` (which symbols the standard has), `numbers`, `collections` (lists, arrays, strings, sequences)
* `syntax` (how forms are written: lambda lists, macros, backquote), `loop`
* `streams`, `packages`, `pathnames`, `objects` (CLOS and structures), `types`, `files`
* `reader`, `printer`, `format`
* `compiler`, `evaluation` (definitions, places, symbols, functions)
* `python` (joins the two languages), `tools` (answers at the prompt), `coverage` (of the standard), `systems` (loads programs)
* `sbcl` (SBCL's own packages: threads, timers, streams of users' classes), `uiop` (the portable functions of ASDF),
  `extension_packages` (makes them when they are named)
* `answers` (at the ports of that room), `package` (makes COMMON-LISP)
* `faces` (show the rooms below)
"""
