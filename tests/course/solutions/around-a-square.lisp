(setf *side* 4)
(defvar *around* 0)
(setf *around* (* 4 *side*))
