;;;; A stand-in for lisp-unit on SBCL, which Debian does not carry; cramhy has one of its own.

(defsystem "lisp-unit" :components ((:file "lisp-unit")))
