"""`python cli.py …` is the installed command `geocontact …`."""

from geocontact.cli.main import main

if __name__ == "__main__":
    main()
