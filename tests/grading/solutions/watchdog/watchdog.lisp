(in-package :tut)

(defun go-in-time (x y seconds)
  (top-level
    (pursue
      (seq
        (move-to (make-3d-vector x y 0))
        :arrived)
      (seq
        (sleep seconds)
        :too-late))))
