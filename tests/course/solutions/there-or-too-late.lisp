(defun reach (x y seconds)
  (top-level
    (with-failure-handling
        ((simple-plan-failure (failure)
           (declare (ignore failure))
           (return :too-late)))
      (pursue
        (progn (sleep seconds) (fail "Too late."))
        (drive-to x y))
      :there)))
