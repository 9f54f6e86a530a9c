(in-package :barista-common)

(define-condition barista-failure (cpl:simple-plan-failure)
  ((description :initarg :description :initform "The barista failed" :reader failure-description))
  (:report (lambda (failure stream)
             (format stream "~a" (failure-description failure)))))

(macrolet ((define-failures (&rest rows)
             `(progn
                ,@(loop for (name parent slot default) in rows
                        collect `(define-condition ,name (,parent)
                                   ((,slot :initarg ,(intern (symbol-name slot) :keyword)
                                           :reader ,(intern (format nil "~a-~a" name slot))
                                           :initform ,default))
                                   (:default-initargs :description ,(substitute #\space #\- (string-downcase name))))))))
  (define-failures
    (cup-not-found barista-failure name nil)
    (pour-failed barista-failure amount 0)
    (cannot-reach barista-failure pose nil)))

(defgeneric failure-summary (failure)
  (:method-combination append)
  (:documentation "What is known of FAILURE, the most special first.")
  (:method append ((failure condition)) (list :type (type-of failure)))
  (:method append ((failure barista-failure)) (list :description (failure-description failure)))
  (:method append ((failure cup-not-found)) (list :name (cup-not-found-name failure)))
  (:method append ((failure pour-failed)) (list :amount (pour-failed-amount failure))))
