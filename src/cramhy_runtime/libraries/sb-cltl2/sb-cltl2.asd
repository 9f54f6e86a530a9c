(defsystem "sb-cltl2" :description "Environments of CLtL2, as the contributed module of SBCL has them." :components ((:file "cltl2")))
