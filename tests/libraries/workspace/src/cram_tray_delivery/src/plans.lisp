(in-package :cram-tray-delivery)

(define-condition tray-dropped (simple-plan-failure)
  ((tray :initarg :tray :reader dropped-tray)))

(defvar *trays-at-table* (make-fluent :name :trays-at-table :value 0))

(defun carry (tray seconds)
  "Carries TRAY for SECONDS. Trays of glass are dropped the first time."
  (sleep seconds)
  (when (eq tray :glass)
    (fail 'tray-dropped :tray tray :format-control "~a is broken" :format-arguments (list tray)))
  tray)

(def-cram-function deliver-tray (log tray &optional (seconds 1))
  (with-retry-counters ((tries 1))
    (let ((carried tray))
      (with-failure-handling
          ((tray-dropped (failure)
             (declare (ignore failure))
             (do-retry tries
               (setf carried :plastic)
               (retry))))
        (carry carried seconds))
      (note-delivery log carried)
      (setf (value *trays-at-table*) (1+ (value *trays-at-table*)))
      carried)))

(def-cram-function deliver-all (log &rest trays)
  (setf (value *trays-at-table*) 0)
  (par-loop (tray trays)
    (deliver-tray log tray)))
