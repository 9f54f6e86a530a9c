"""UIOP, the portable functions that come with ASDF: what ``.asd`` files, scripts and libraries call of the system, of files and streams.

A library that names SBCL's own functions runs on SBCL only; one that names UIOP's runs on all Lisps that have ASDF, and here.
Where the parts are:

* `texts`      the few names that ``.asd`` files use all the time; they are made when the session starts
* `utilities`, `pathnames`, `files`, `streams`, `processes`, `packages`, `macros`  the others, by UIOP's own chapters
* `configuration`  folders of settings, command lines of Windows, hooks; `settings` files of settings, places in them, packages as forms
* `building`   compiling files, fatal conditions, and why no image can be saved
* `names`      which names the package has

All but `texts` is imported when a program first names something of it (`extension_packages.LatePackage`). What UIOP does to the
image of another Lisp (``dump-image`` and its like) is an error that says why. Source: UIOP's manual; texts are UIOP's.
"""
