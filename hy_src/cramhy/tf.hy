"The macro of CL-TF (cl-transforms.md section 6). The package is made on demand, and this file is read with it."

(require cramhy.operators [defoperator])
(import cramhy.operators *)

(setv package "CL-TF")

(defoperator with-tf-broadcasting [broadcaster-and-transforms #* body]
  (setv #(broadcaster #* transforms) broadcaster-and-transforms)
  `(cl-tf::while-broadcasting ~broadcaster (list ~@transforms) (lambda [] ~@body)))
