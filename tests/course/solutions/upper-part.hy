(setv high (> (fl-funcall (fn [pose] pose.y) turtle-pose) 8))
