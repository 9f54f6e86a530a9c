(in-package :tut)

(def-fact-group flat ()
  (<- (next-to ?one ?other) (passage ?one ?other))
  (<- (next-to ?one ?other) (passage ?other ?one))
  (<- (way ?to ?to ?seen ?seen))
  (<- (way ?from ?to ?seen ?rooms)
    (next-to ?from ?next)
    (cl:not (member ?next ?seen))
    (way ?next ?to (?next . ?seen) ?rooms)))

(defun shortest-way (from to)
  (let ((best nil))
    (cut:lazy-dolist (bindings (cram-prolog:prolog `(way ,from ,to (,from) ?rooms)) best)
      (let ((rooms (reverse (cut:var-value '?rooms bindings))))
        (when (or (null best) (< (length rooms) (length best)))
          (setf best rooms))))))

(defun middle (room)
  (let ((found (cut:lazy-car (cram-prolog:prolog `(room ,room ?x ?y)))))
    (make-3d-vector (cut:var-value '?x found) (cut:var-value '?y found) 0)))

(defun drive-through (from to)
  (top-level
    (let ((rooms (shortest-way from to)))
      (unless rooms
        (fail 'no-way))
      (dolist (room (rest rooms))
        (move-to (middle room)))
      rooms)))
