from rilo._command import main

main()
