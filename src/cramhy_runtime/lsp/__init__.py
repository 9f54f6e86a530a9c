"""The language server, ``cramhy lsp``: diagnostics, completion, hover, definitions, renaming and indentation for editors.

`server` speaks the protocol, by pygls (extra ``lsp``), and `documents` has the texts. `checking` finds what is wrong with a text of Common
Lisp, by our reader and compiler, in an image that `surroundings` makes; `hy_files`, `system_files` and `manifests` do so for plain Hy,
``.asd`` and ``package.xml``. `answers` asks the functions of the session room that the prompt and Swank ask, too. `texts` finds places,
`scopes` what a local name means, `outlines` the parts of a text, `indentation` how it is indented.

Importing this room loads no package of the extra; `server` does.
"""
