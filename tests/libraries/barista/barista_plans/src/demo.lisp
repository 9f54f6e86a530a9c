(in-package :barista-plans)

(defun run-demo (&optional (guests '((cup-1 :milk (0 2)) (glass-1 :tea (0 -2)) (mug-1 :ice (1 1)))))
  (reset-world)
  (let ((answers (serve-guests guests)))
    (values answers (copy-list *log*))))
