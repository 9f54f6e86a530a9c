"""A session in a browser's tab, on Pyodide: Python, compiled to WebAssembly. Nothing has to be installed to use it.

* `site`           writes the site: Python, our packages and the page, as static files; ``cramhy browser`` calls it
* `pyodide_files`  the files of Pyodide, in the one version that this is made for, and what is mended in them
* `left_out`       the rooms that no tab can use, and what is said of them there
* `packing`        compiles and packs our packages; it runs in Pyodide, which ``pack.mjs`` starts in Node
* `tab`            the session in the tab; it runs there only. `port` connects it with the page's views
* ``static/``      the page's own files: the worker, the prompt, the transport, the service worker

How tasks get their stacks there is the kernel's matter: ``kernel/backends/jspi.py``.
"""
