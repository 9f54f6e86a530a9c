(defsystem "sb-rt" :description "The regression tester RT, as the contributed module of SBCL has it." :components ((:file "rt")))
