;;;; A* over any graph, and over the cells of a costmap.

(in-package #:courier-plans)

(defun search (start &key goal-p successors (heuristic (constantly 0)) (test #'equal) limit)
  "The cheapest path from START, its cost and the number of nodes that were opened; SUCCESSORS gives (node . cost) pairs."
  (let ((costs (make-hash-table :test test))
        (parents (make-hash-table :test test))
        (queue (make-queue :key #'car))
        (opened 0))
    (setf (gethash start costs) 0)
    (queue-push queue (list (funcall heuristic start) 0 start))
    (do-queue (entry queue (values nil nil opened))
      (destructuring-bind (estimate order node) entry
        (declare (ignore estimate order))
        (incf opened)
        (cond ((funcall goal-p node)
               (return (values (loop for place = node then (gethash place parents)
                                     while place
                                     collect place into path
                                     finally (return (nreverse path)))
                               (gethash node costs)
                               opened)))
              ((and limit (>= opened limit))
               (return (values nil :limit opened))))
        (loop for (next . cost) in (funcall successors node)
              for total = (+ (gethash node costs) cost)
              when (< total (gethash next costs most-positive-fixnum))
                do (setf (gethash next costs) total
                         (gethash next parents) node)
                   (queue-push queue (list (+ total (funcall heuristic next)) opened next)))))))

(defun find-path (map from to &rest options &key (diagonal nil) &allow-other-keys)
  "The cells from FROM to TO, lists (x y), through MAP; its values cost extra."
  (flet ((straight (node) (+ (abs (- (first node) (first to))) (abs (- (second node) (second to))))))
    (apply #'search from
           :goal-p (lambda (node) (equal node to))
           :heuristic (if diagonal (constantly 0) #'straight)
           :successors (lambda (node)
                         (destructuring-bind (x y) node
                           (loop for (nx ny) in (neighbours map x y :diagonal diagonal)
                                 collect (cons (list nx ny) (+ 1 (value-at map nx ny))))))
           (loop for (key value) on options by #'cddr
                 unless (member key '(:diagonal))
                   collect key and collect value))))

(defun path-cost (map path)
  (loop for (x y) in (rest path) sum (1+ (value-at map x y))))

(defun corners (path)
  "PATH without the cells at which it goes straight on."
  (if (null (cddr path))
      path
      (cons (first path)
            (loop for (a b c) on path
                  while c
                  unless (equal (mapcar #'- b a) (mapcar #'- c b))
                    collect b into turns
                  finally (return (append turns (last path)))))))
