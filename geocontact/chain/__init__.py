"""What a system is made of: motion, geometry, law, balance, sensor; and what it means to add an effect to one."""
