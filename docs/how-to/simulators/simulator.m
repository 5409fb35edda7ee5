function simulator(params, trial, out)
% One trial by MATLAB or Simulink:
%   geocontact gap init --data recordings --number k=100 --number neutral=0 ...
%     --simulator "matlab -batch simulator('{params}','{trial}','{out}')"
% MATLAB starts anew for each run, and a diagnosis needs thousands: export a Simulink model as an FMU where you can.
numbers = jsondecode(fileread(params));
recorded = readmatrix(trial, 'NumHeaderLines', 1);
time = recorded(:, 1);
angle = recorded(:, 2);
torque = numbers.k * sin(angle - numbers.neutral);
% Simulink, in place of the line above:
%   in = Simulink.SimulationInput('strut');
%   in = in.setVariable('k', numbers.k).setVariable('neutral', numbers.neutral);
%   in = in.setExternalInput([time angle]).setModelParameter('StopTime', num2str(time(end)));
%   found = sim(in);
%   torque = interp1(found.yout{1}.Values.Time, found.yout{1}.Values.Data, time);
file = fopen(out, 'w');
fprintf(file, 'time [s],torque [N m]\n');
fprintf(file, '%.17g,%.17g\n', [time torque].');
fclose(file);
end
