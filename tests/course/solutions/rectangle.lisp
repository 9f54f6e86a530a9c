(defun rectangle-around (width height)
  (* 2 (+ width height)))
