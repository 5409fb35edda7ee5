"""A simulated arm beside what was recorded."""
