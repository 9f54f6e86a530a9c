;;;; Reports for people: FORMAT, and the printing of data.

(in-package #:courier-plans)

(defgeneric report (thing &optional stream)
  (:documentation "Print THING for people.")
  (:method :before ((thing standard-object) &optional (stream *standard-output*))
    (format stream "~&--- ~:(~A~) ---~%" (substitute #\Space #\- (string (type-of thing))))))

(defmethod report ((log event-log) &optional (stream *standard-output*))
  (map nil (lambda (event) (write-line (event-line event) stream)) (events log))
  (let ((summary (summary log)))
    (format stream "~&~D action~:P, ~[no failure~;one failure~:;~:*~D failures~], from ~D to ~D s.~%"
            (getf summary :starts) (getf summary :failures) (getf summary :from) (getf summary :to))
    (format stream "~{~{~(~A~)~10T~3D ~}~V@{~A~:*~}~*~%~}"
            (loop for (action . count) in (getf summary :actions)
                  collect (list action count) collect count collect "*"))))

(defmethod report ((world world) &optional (stream *standard-output*))
  (let ((*world* world))
    (table '("object" "where" "kg" "hazards")
           (loop for thing in (objects-of 'movable)
                 collect (list (name thing) (or (location-of (name thing)) "-") (total-weight thing) (hazards thing)))
           :stream stream :alignment '(:right :both :left))))

(defmethod report ((robot robot) &optional (stream *standard-output*))
  (format stream "~A at ~(~A~), battery ~D%, ~,2F m, arms ~{~A~^ ~}.~%"
          robot (robot-place robot) (battery robot) (mileage robot) (arms robot)))

(defmethod report ((plan cons) &optional (stream *standard-output*))
  (format stream "~&~:{~2@T~10A~@{ ~(~A~)~}~%~}" plan))

(defmethod report ((condition condition) &optional (stream *standard-output*))
  (format stream "~A: ~A~%" (type-of condition) condition))

(defmethod report ((nothing null) &optional (stream *standard-output*))
  (format stream "~&Nothing.~%"))

(defmethod report ((thing t) &optional (stream *standard-output*))
  (format stream "~&~S~%" thing))

(defun formats (&optional (stream *standard-output*))
  "Directives that reports are made of."
  (macrolet ((show (&rest cases)
               `(progn ,@(loop for (control . arguments) in cases
                               collect `(format stream "~&~22S ~?|~%" ,control ,control (list ,@arguments))))))
    (show ("~D ~5D ~:D ~@D" 42 42 1234567 7)
          ("~5,'0D ~,,'.,4:D" 42 12345678)
          ("~B ~O ~X ~12R" 10 64 255 143)
          ("~R ~:R ~@R ~:@R" 1999 21 1999 9)
          ("~F ~,2F ~8,3F ~,1F" 1.5d0 2.345d0 pi 0.05d0)
          ("~E ~,2E" 12345.678d0 0.00012d0)
          ("~$ ~2,5$" 3.14159d0 2.5d0)
          ("~A ~S ~:A" "text" "text" nil)
          ("~10A|~10@A|~6,,2,'.A" 'left 'right "pad")
          ("~C ~:C ~@C" #\a #\Space #\Newline)
          ("~P ~:*~D ~:*thing~P" 1)
          ("~[zero~;one~:;many~] ~:[no~;yes~] ~@[~A~]" 2 t 5)
          ("~{~A~^, ~}; ~:{<~A ~A>~}; ~@{~A~^+~}" '(1 2 3) '((a 1) (b 2)) 7 8 9)
          ("~2{~A ~}" '(1 2 3 4))
          ("~(ABC~) ~:(hello world~) ~@(hELLO~) ~:@(up~)")
          ("~20<left~;mid~;right~>|~10:@<x~>" )
          ("~5T.~20T.~3@T.")
          ("~*~A ~:*~A ~0@*~A" 1 2)
          ("~? ~@?" "~A-~A" '(1 2) "~A" 3)
          ("~V,'*D ~#[none~;one~:;some~]" 6 42 1 2)
          ("a~
            b~%~&c~~~|" )
          ("~S ~S ~S" 1/3 #C(1 2) 1d10)
          ("~S ~S ~S" '|odd name| :key '#:free))))

(defparameter *recipe*
  '(defun set-the-table (guests &key (style :breakfast) hurry)
    (let ((cups (objects-of 'cup)) (plates (objects-of 'plate)))
      (when (< (length cups) guests) (error 'not-enough :what 'cups :wanted guests :there (length cups)))
      (loop for guest from 1 to guests for cup in cups for plate in plates
            do (with-recovery ((grasp-failed (failure :retries 2) (retry))) (bring cup `(seat ,guest)) (bring plate `(seat ,guest))))
      (if hurry (values style :fast) #'(lambda (x) (list x style))))))

(defun pretty-data (&optional (stream *standard-output*))
  (let ((*print-pretty* t) (*print-right-margin* 70))
    (format stream "~&~S~%" *recipe*)
    (format stream "~&~S~%" (loop for i below 30 collect (make-symbol-list i)))
    (pprint (make-operator :name 'wipe :parameters '(?surface) :preconditions '((holding sponge) (dirty ?surface))
                           :add '((clean ?surface)) :delete '((dirty ?surface)))
            stream)
    (let ((*print-length* 5) (*print-level* 2))
      (format stream "~&~S~%" '(1 (2 (3 (4))) 5 6 7 8)))
    (pprint-logical-block (stream '(alpha beta gamma delta epsilon zeta eta theta iota kappa) :prefix "<" :suffix ">")
      (loop (pprint-exit-if-list-exhausted)
            (write (pprint-pop) :stream stream)
            (pprint-exit-if-list-exhausted)
            (write-char #\Space stream)
            (pprint-newline :fill stream)))
    (terpri stream)))

(defun make-symbol-list (i)
  (list (intern (format nil "STEP-~D" i) :courier-plans) i))
