"""The language server, ``cramhy lsp``: diagnostics, completion, hover, definitions, renaming and indentation for editors.

`server` speaks the protocol, by pygls (extra ``lsp``), and `documents` has the texts.

* What is wrong with a text: `checking` asks our reader and compiler, in an image that `surroundings` makes. `hy_files`, `system_files` and
  `manifests` do so for plain Hy, ``.asd`` and ``package.xml``. `plan_checks` looks at names that are data in plans, by the `known_names`
  of a system.
* What is asked of a place: `answers` asks the functions of the session room that the prompt and Swank ask, too. `texts` finds places,
  `scopes` what a local name means, `meanings` which symbol a word stands for, `neighbours` the other files of a system.
* The form of a text: `outlines` has its parts, `indentation` says how it is indented.
* What runs: `lenses` says which plans and tests can be run from the editor, and `running` runs them.

Importing this room loads no package of the extra; `server` does.
"""
