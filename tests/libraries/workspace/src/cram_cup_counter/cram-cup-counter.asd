;;; -*- lisp -*-

(defsystem "cram-cup-counter"
  :depends-on ("bordeaux-threads" "trivial-garbage" "closer-mop" "trivial-gray-streams" "cffi")
  :pathname "src/"
  :serial t
  :components ((:file "package")
               (:file "camera")
               (:file "counter")
               (:file "report")))

(defsystem "cram-cup-counter/test"
  :depends-on ("cram-cup-counter" "lisp-unit")
  :pathname "test/"
  :serial t
  :components ((:file "package")
               (:file "counter-tests")
               (:file "report-tests")))

(defmethod asdf:perform ((operation asdf:test-op) (component (eql (asdf:find-system "cram-cup-counter/test"))))
  (flet ((symbol (name) (intern (string-upcase name) :lisp-unit))
         (condition () :all))
    (setf (symbol-value (symbol "*print-failures*")) t)
    (funcall (symbol "run-tests") (condition) :cram-cup-counter-test)))
