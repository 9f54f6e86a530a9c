;;;; Print what the system kitchen-courier prints: its transcript, and the summary of its tests.
;;;;     sbcl --script transcript.lisp > kitchen-courier/transcript.txt

(require :asdf)

(let ((here (directory-namestring *load-truename*)) (*standard-output* (make-broadcast-stream))
      (*error-output* (make-broadcast-stream)))
  (setf asdf:*central-registry* (list (concatenate 'string here "kitchen-courier/") (concatenate 'string here "lisp-unit/")))
  (asdf:load-system "kitchen-courier/tests"))

(funcall (intern "MAIN" "COURIER-PLANS"))
(asdf:test-system "kitchen-courier/tests")
