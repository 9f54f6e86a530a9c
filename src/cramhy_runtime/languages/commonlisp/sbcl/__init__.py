"""SBCL's own packages, as far as programs that others wrote name them: SB-THREAD, SB-EXT, SB-SYS, SB-POSIX, SB-DEBUG, SB-GRAY, SB-MOP.

Nothing here is an operating system's thread, lock or timer. A thread is a task of the kernel, waiting is the kernel's, and time is the
kernel's, so in virtual time a program with threads and timeouts gives the same run every time.

* `packages`       which names these packages have; `operators` their macros
* `threads`        threads; `mutexes` mutexes and wait queues
* `deadlines`      ``with-timeout`` and ``with-deadline``; `timers` functions that are called at a time
* `weak_pointers`  weak pointers, finalizers, the collector; `extensions` the rest of SB-EXT
* `posix`          the environment and a few calls of the system; `backtraces` what was called
* `gray_streams`   streams whose functions users define; `metaobjects` more of SB-MOP

All of it is imported when a program first names something of it (`extension_packages.LatePackage`). Source: SBCL's manual; texts are those
of SBCL 2.2.9.
"""
