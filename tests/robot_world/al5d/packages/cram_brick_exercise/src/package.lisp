(defpackage :cram-brick-exercise
  (:nicknames :bex)
  (:use :cpl :cl-transforms :roslisp :roslisp-utilities :cram-designators :cram-process-modules :cram-language-designator-support)
  (:import-from :cram-prolog :def-fact-group :<-))
