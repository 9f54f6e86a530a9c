;;;; cffi-toolchain: the names by which a system calls the compiler and the linker of C. They are not called: each function refuses.

(defpackage #:cffi-toolchain
  (:use #:common-lisp)
  (:export #:*cc* #:*cc-flags* #:*ld* #:*ld-dll-flags* #:*ld-exe-flags* #:*linkkit-end* #:*linkkit-start* #:c-file #:cc-compile #:invoke
           #:invoke-build #:link-executable #:link-lisp-executable #:link-shared-library #:link-static-library #:make-c-file-name
           #:make-exe-file-name #:make-o-file-name #:make-so-file-name #:o-file #:parse-command-flags #:parse-command-flags-list))

(in-package #:cffi-toolchain)

(defvar *cc* "cc" "The compiler of C.")
(defvar *cc-flags* '())
(defvar *ld* "cc" "The linker of C.")
(defvar *ld-exe-flags* '())
(defvar *ld-dll-flags* '())
(defvar *linkkit-start* nil)
(defvar *linkkit-end* nil)

(defclass c-file (asdf:c-source-file) ())
(defclass o-file (asdf:source-file) ())

(macrolet ((refused (&rest names)
             `(progn ,@(loop for name in names
                             collect `(defun ,name (&rest arguments)
                                        "The error that C is not compiled."
                                        (declare (ignore arguments))
                                        (cffi::refuse ',name))))))
  (refused cc-compile invoke invoke-build link-executable link-lisp-executable link-shared-library link-static-library))

(defun file-name (kind file)
  "The pathname FILE with the type KIND."
  (make-pathname :type kind :defaults file))

(defun make-c-file-name (file &optional suffix)
  "The file of C beside FILE, with SUFFIX behind its name."
  (file-name "c" (make-pathname :name (concatenate 'string (pathname-name file) suffix) :defaults file)))

(defun make-o-file-name (file &optional suffix)
  "The object file beside FILE, with SUFFIX behind its name."
  (file-name "o" (make-pathname :name (concatenate 'string (pathname-name file) suffix) :defaults file)))

(defun make-so-file-name (file)
  "The shared library beside FILE."
  (file-name "so" file))

(defun make-exe-file-name (file)
  "The program beside FILE."
  (file-name nil file))

(defun parse-command-flags (flags)
  "The words of the string FLAGS."
  (remove "" (uiop:split-string flags :separator " ") :test #'string=))

(defun parse-command-flags-list (strings)
  "The words of all STRINGS, as one list."
  (mapcan #'parse-command-flags strings))
