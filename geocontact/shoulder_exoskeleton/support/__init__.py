"""Support that follows the work: which phase it is, how much support each phase gets, which support is best."""
