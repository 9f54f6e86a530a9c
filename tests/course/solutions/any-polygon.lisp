(defun draw-polygon (corners)
  (dotimes (i corners)
    (ahead 1)
    (left (/ 360 corners))))
