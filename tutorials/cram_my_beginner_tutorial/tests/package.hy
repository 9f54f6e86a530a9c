(require cramhy *)

(defpackage :cram-my-beginner-tutorial-tests
  (:nicknames :tut-tests)
  (:use :common-lisp :lisp-unit :cl-transforms :roslisp)
  (:import-from :cram-my-beginner-tutorial :relative-angle-to))
